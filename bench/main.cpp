// pellucid_bench: GPU times of the module and of others beside their errors. What is timed is checked first.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "commit.h"
#include "common/error.h"
#include "compare_runs.h"
#include "context_creation.h"
#include "frames.h"
#include "options.h"
#include "plane.h"
#include "scene.h"
#include "sweep.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;
using Json = nlohmann::json;

Json readResults(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path.string(), "", "cannot be read");
  Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) throw InputError(path.string(), "", "holds no results of pellucid_bench");
  return json;
}

// One line a row, so that files of a thousand rows stay readable, and so do their differences.
std::string textOf(Json json) {
  const Json rows = std::move(json["results"]);
  json.erase("results");
  std::string text = json.dump(1);
  text.resize(text.rfind('\n'));
  text += ",\n \"results\": [";
  for (size_t i = 0; i < rows.size(); ++i) text += std::string(i == 0 ? "\n  " : ",\n  ").append(rows[i].dump());
  return text + "\n ]\n}\n";
}

void write(Json json, const Options& options) {
  if (options.ratios) {
    json.erase("floor_us");
    for (Json& row : json["results"])
      for (const char* time : {"us", "p10_us", "p90_us", "floor_us", "cpu_us", "cpu_plan_us",
                               "cpu_constants_us", "cpu_record_us"})
        row.erase(time);
  }
  if (options.json == "-") {
    std::fputs(textOf(std::move(json)).c_str(), stdout);
  } else if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << textOf(std::move(json));
    if (!file.flush()) throw InputError(options.json, "", "cannot be written");
  }
}

Json measureAll(const Options& options) {
  const auto wanted = [&](const char* name) { return options.tables.count(name) > 0; };
  Device device({options.device, false});
  const bool software = device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const int repeat = options.repeat.value_or(software ? 3 : 7);
  const Context context(device);
  const PellucidMaterial material = benchMaterial();
  const Site site{device, context, material, pixelSizeFor(material, options.plane.radius)};

  std::FILE* table = options.json == "-" ? stderr : stdout;
  std::fprintf(table, "%s, commit %s, median of %d\n", device.description().c_str(), PELLUCID_COMMIT, repeat);
  Report report(table, 1);
  Json json = {{"device", device.description()}, {"commit", PELLUCID_COMMIT}, {"repeat", repeat}};
  std::map<std::string, std::vector<Plot>> plots;
  if (std::any_of(std::begin(kPlaneTables), std::end(kPlaneTables), wanted)) {
    const auto [width, height] = options.plane.size;
    report.note("planes of " + std::to_string(width) + " x " + std::to_string(height) + ", radius " +
                std::to_string(std::lround(options.plane.radius)) + " pixels");
    PlanePlots planes = measurePlanes(site, options.tables, options.plane, repeat, report);
    plots["diffusion"] = std::move(planes.diffusion);
    plots["gather"] = std::move(planes.gather);
    json.update({{"width", width},
                 {"height", height},
                 {"radius_pixels", options.plane.radius},
                 {"floor_us", planes.floor}});
  }
  Json swept = Json::array();
  if (wanted("sweep")) swept = sweep(site, options.sweep, repeat, table, &plots["sweep"]);
  if (wanted("frames"))
    for (auto& [size, frames] : measureFrames(device, context, options.frames, repeat, report))
      plots["frames_" + size] = std::move(frames);
  if (wanted("context")) measureContextCreation(options.device, repeat, report);
  for (const auto& [name, drawn] : plots) {
    if (options.plot.empty() || drawn.empty()) continue;
    std::filesystem::create_directories(options.plot);
    writePlot(options.plot / (name + ".png"), drawn);
  }
  json["results"] = report.rows();
  json["results"].insert(json["results"].end(), swept.begin(), swept.end());
  return json;
}

int run(const Options& options) {
  if (options.createContext) return createContext(options);
  // Before a run of minutes.
  const Json before = options.compare.empty() ? Json() : readResults(options.compare);
  const bool stored = !options.results.empty();
  const Json now = stored ? readResults(options.results) : measureAll(options);
  if (!stored) write(now, options);
  if (options.compare.empty()) return 0;
  return printWhatGrew(before, now, options.json == "-" ? stderr : stdout) > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (const int status = readOptions(argc, argv, options); status >= 0) return status;
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_bench: %s\n", e.what());
    return dynamic_cast<const DeviceError*>(&e) ? 4 : 3;
  }
}
