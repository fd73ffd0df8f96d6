// pellucid_bench: GPU times of the module and of others beside their errors. What is timed is checked first.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "commit.h"
#include "common/error.h"
#include "compare_runs.h"
#include "context_creation.h"
#include "frames.h"
#include "options.h"
#include "submission.h"
#include "thesis.h"

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
  for (size_t i = 0; i < rows.size(); ++i)
    text += std::string(i == 0 ? "\n  " : ",\n  ").append(rows[i].dump());
  return text + "\n ]\n}\n";
}

void write(Json json, const Options& options) {
  if (options.ratios) {
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

class Run {
public:
  explicit Run(const Options& options)
      : options_(options),
        device_({options.device, false}),
        software_(device_.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU),
        repeat_(options.repeat.value_or(software_ ? 3 : 7)),
        table_(options.json == "-" ? stderr : stdout),
        report_(table_) {}

  // `keep` gets all results so far after each section: a run that is killed keeps what it has measured.
  template <class Keep>
  Json measure(const Keep& keep) {
    std::fprintf(table_, "%s, commit %s, median of %d\n", device_.description().c_str(), PELLUCID_COMMIT,
                 repeat_);
    const uint32_t vulkan = device_.properties().apiVersion;
    json_ = {{"device", device_.description()},
             {"device_name", device_.properties().deviceName},
             {"vulkan", std::to_string(VK_API_VERSION_MAJOR(vulkan)) + "." +
                            std::to_string(VK_API_VERSION_MINOR(vulkan)) + "." +
                            std::to_string(VK_API_VERSION_PATCH(vulkan))},
             {"commit", PELLUCID_COMMIT},
             {"repeat", repeat_}};
    // Bad files are named before the context takes its time.
    std::vector<FrameSource> sources;
    if (wanted("frames")) sources = frameSources(device_, options_.frames);
    if (options_.tables != std::set<std::string>{"context"}) {
      measureTimes(sources);
      writePlots();
      keep(withResults());
    }
    if (wanted("context")) measureContextCreation(options_.device, repeat_, report_);
    return withResults();
  }

private:
  bool wanted(const char* name) const { return options_.tables.count(name) > 0; }

  Json withResults() const {
    Json json = json_;
    json["results"] = report_.rows();
    return json;
  }

  void writePlots() const {
    for (const auto& [name, drawn] : plots_) {
      if (options_.plot.empty() || drawn.empty()) continue;
      std::filesystem::create_directories(options_.plot);
      writePlot(options_.plot / (name + ".png"), drawn);
    }
  }

  void measureTimes(const std::vector<FrameSource>& sources) {
    const Context context(device_);
    if (wanted("thesis")) measureThesis(device_, context, options_.frames, repeat_, report_);
    if (wanted("frames"))
      for (auto& [size, frames] : measureFrames(device_, context, sources, options_.frames, repeat_, report_))
        plots_["frames_" + size] = std::move(frames);
  }

  const Options& options_;
  Device device_;
  bool software_;
  int repeat_;
  std::FILE* table_;
  Report report_;
  Json json_;
  std::map<std::string, std::vector<Plot>> plots_;
};

int run(const Options& options) {
  if (options.createContext) return createContext(options);
  // Before a run of minutes.
  const Json before = options.compare.empty() ? Json() : readResults(options.compare);
  const bool stored = !options.results.empty();
  const Json now = stored ? readResults(options.results) : Run(options).measure([&](const Json& json) {
    if (options.json != "-") write(json, options);
  });
  if (!stored) write(now, options);
  if (!options.submit.empty()) writeSubmission(now, options.submit);
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
