#include "submission.h"

#include <fstream>

#include "common/error.h"
#include "pellucid/pellucid.h"

namespace pellucid::bench {

using harness::InputError;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

bool isFrame(const json& row, const char* kind) {
  return row.value("section", "") == "frames" && row.value("kind", "") == kind;
}

}  // namespace

ordered_json submission(const json& results) {
  for (const char* field : {"device", "device_name", "vulkan", "commit", "repeat", "results"})
    if (!results.contains(field))
      throw InputError("--submit", field, "is not in these results; measure again");
  const std::string name = results["device_name"], description = results["device"];
  ordered_json frames = ordered_json::array();
  for (const json& row : results["results"]) {
    if (isFrame(row, "frame"))
      frames.push_back({{"frame", row.at("frame")},
                        {"size", row.at("size")},
                        {"covered", row.at("covered")},
                        {"us", ordered_json::object()}});
    if (!isFrame(row, "whole") || !row.contains("us")) continue;
    const auto differs = [&](const char* field) {
      return frames.back()[field].get<std::string>() != row.at(field).get<std::string>();
    };
    if (frames.empty() || differs("frame") || differs("size"))
      throw InputError("--submit", row.at("frame"), "has times before it is described");
    frames.back()["us"][row.at("name").get<std::string>()] = row["us"];
  }
  if (frames.empty()) throw InputError("--submit", "results", "has no section \"frames\"; see --tables");
  for (const ordered_json& frame : frames)
    if (frame["us"].empty()) throw InputError("--submit", frame["frame"], "has no times");
  // The description is "name, driver", where a driver says what it is.
  const std::string driver = description.size() > name.size() + 2 ? description.substr(name.size() + 2) : "";
  return {{"pellucid", PELLUCID_VERSION},
          {"commit", results["commit"]},
          {"device", name},
          {"driver", driver},
          {"vulkan", results["vulkan"]},
          {"repeat", results["repeat"]},
          {"unit", "us, median of the runs"},
          {"frames", frames}};
}

void writeSubmission(const json& results, const std::filesystem::path& path) {
  const ordered_json content = submission(results);
  std::ofstream file(path);
  file << content.dump(1) << "\n";
  if (!file.flush()) throw InputError(path.string(), "", "cannot be written");
}

}  // namespace pellucid::bench
