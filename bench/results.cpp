#include "results.h"

#include <fstream>
#include <map>
#include <string>

#include "common/error.h"
#include "common/whole_file.h"

namespace pellucid::bench {

using harness::InputError;
using Json = nlohmann::json;

Json readResults(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path.string(), "", "cannot be read");
  Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) throw InputError(path.string(), "", "holds no results of pellucid_bench");
  return json;
}

void writeResults(Json results, const std::string& file) {
  Json rows = std::move(results["results"]);
  results.erase("results");
  // One line a row, so that files of a thousand rows stay readable, and so do their differences.
  std::string text = results.dump(1);
  text.resize(text.rfind('\n'));
  text += ",\n \"results\": [";
  for (size_t i = 0; i < rows.size(); ++i)
    text += std::string(i == 0 ? "\n  " : ",\n  ").append(rows[i].dump());
  text += "\n ]\n}\n";
  if (file == "-")
    std::fputs(text.c_str(), stdout);
  else
    harness::writeWholeText(file, text);
}

namespace {

const char* const kErrors[] = {"relative_rmse", "truth_relative_rmse", "flip",
                               "spots",         "spots_appear",        "spots_vanish"};

// By what a row measures, in words that sort.
std::map<std::string, const Json*> rowsOf(const Json& run) {
  std::map<std::string, const Json*> rows;
  for (const Json& row : run.at("results")) {
    std::string key = row.at("section").get<std::string>();
    for (const char* field : {"frame", "size", "kind", "of", "name"})
      if (row.contains(field)) key += ": " + row[field].get<std::string>();
    rows[key] = &row;
  }
  return rows;
}

double number(const Json& row, const char* field) {
  return row.contains(field) && row[field].is_number() ? row[field].get<double>() : 0;
}

bool isSlower(const Json& before, const Json& now) {
  return before.contains("us") && now.contains("us") && number(now, "p10_us") > number(before, "p90_us") &&
         number(now, "us") > (1 + kSameTime) * number(before, "us");
}

bool hasTimes(const Json& run) {
  for (const Json& row : run.at("results"))
    if (row.contains("us")) return true;
  return false;
}

int count(const Json& before, const Json& now, std::FILE* out) {
  if (hasTimes(before) && hasTimes(now) && before.at("device") != now.at("device"))
    throw InputError("", "device",
                     "times of " + before.at("device").get<std::string>() + " and of " +
                         now.at("device").get<std::string>() + " are not to be compared");
  const auto old = rowsOf(before), recent = rowsOf(now);
  int grew = 0;
  size_t common = 0;
  for (const auto& [key, row] : recent) {
    const auto match = old.find(key);
    if (match == old.end()) continue;
    ++common;
    const Json& was = *match->second;
    if (isSlower(was, *row)) {
      ++grew;
      std::fprintf(out, "slower: %s: %.1f us (%.1f .. %.1f) and not %.1f us (%.1f .. %.1f)\n", key.c_str(),
                   number(*row, "us"), number(*row, "p10_us"), number(*row, "p90_us"), number(was, "us"),
                   number(was, "p10_us"), number(was, "p90_us"));
    }
    for (const char* field : kErrors)
      if (was.contains(field) && number(*row, field) > (1 + kSameError) * number(was, field)) {
        ++grew;
        std::fprintf(out, "worse: %s: %s %.4g and not %.4g\n", key.c_str(), field, number(*row, field),
                     number(was, field));
      }
  }
  std::fprintf(out, "%zu rows compared, %d grew; %zu are new, %zu were not measured\n", common, grew,
               recent.size() - common, old.size() - common);
  return grew;
}

}  // namespace

int printWhatGrew(const Json& before, const Json& now, std::FILE* out) {
  try {
    return count(before, now, out);
  } catch (const Json::exception& e) {
    throw InputError("", "results", std::string("these are not of pellucid_bench: ") + e.what());
  }
}

}  // namespace pellucid::bench
