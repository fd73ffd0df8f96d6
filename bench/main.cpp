// pellucid_bench: GPU times of the module and of others beside their errors. What is timed is checked first.
#include <cstdio>
#include <set>

#include "commit.h"
#include "common/error.h"
#include "options.h"
#include "results.h"
#include "sections.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;
using Json = nlohmann::json;

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
    json_ = {{"device", device_.description()}, {"commit", PELLUCID_COMMIT}, {"repeat", repeat_}};
    // Bad files are named before the context takes its time.
    std::vector<FrameSource> sources;
    if (wanted("frames")) sources = frameSources(device_, options_.frames);
    if (options_.tables != std::set<std::string>{"context"}) {
      measureTimes(sources);
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

  void measureTimes(const std::vector<FrameSource>& sources) {
    const Context context(device_);
    if (wanted("paths")) measurePaths(device_, context, options_.frames, repeat_, report_);
    if (wanted("frames")) measureFrames(device_, context, sources, options_.frames, repeat_, report_);
  }

  const Options& options_;
  Device device_;
  bool software_;
  int repeat_;
  std::FILE* table_;
  Report report_;
  Json json_;
};

int run(const Options& options) {
  if (options.createContext) return createContext(options);
  const auto keep = [&](const Json& json) {
    if (!options.json.empty() && options.json != "-") writeResults(json, options.json);
  };
  const Json json = Run(options).measure(keep);
  if (!options.json.empty()) writeResults(json, options.json);
  return 0;
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
