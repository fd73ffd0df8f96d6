// pellucid_bench: GPU times of the module and of others beside their errors. What is timed is checked first.
#include <cstdio>

#include "commit.h"
#include "common/error.h"
#include "common/whole_file.h"
#include "options.h"
#include "sections.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;
using Json = nlohmann::json;

// To a file, or to standard output for "-".
void writeResults(const Json& head, const Json& rows, const std::string& file) {
  // One line a row, so that files of a thousand rows stay readable, and so do their differences.
  std::string text = head.dump(1);
  text.resize(text.rfind('\n'));
  text += ",\n \"results\": [";
  for (size_t i = 0; i < rows.size(); ++i)
    text += std::string(i == 0 ? "\n  " : ",\n  ").append(rows[i].dump());
  text += "\n ]\n}\n";
  if (file == "-")
    std::fputs(text.c_str(), stdout);
  else
    writeWholeText(file, text);
}

int run(const Options& options) {
  if (options.createContext) return createContext(options);
  Device device({options.device, false});
  const bool software = device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  const int repeat = options.repeat.value_or(software ? 3 : 7);
  std::FILE* const table = options.json == "-" ? stderr : stdout;
  Report report(table);
  std::fprintf(table, "%s, commit %s, median of %d\n", device.description().c_str(), PELLUCID_COMMIT, repeat);
  const Json head = {{"device", device.description()}, {"commit", PELLUCID_COMMIT}, {"repeat", repeat}};
  const bool paths = options.tables.count("paths") > 0, frames = options.tables.count("frames") > 0;
  // Bad files are named before the context takes its time.
  std::vector<FrameSource> sources;
  if (frames) sources = frameSources(device, options.frames);
  if (paths || frames) {
    const Context context(device);
    if (paths) measurePaths(device, context, options.frames, repeat, report);
    if (frames) measureFrames(device, context, sources, options.frames, repeat, report);
    // A run that is killed keeps what it has measured.
    if (!options.json.empty() && options.json != "-") writeResults(head, report.rows(), options.json);
  }
  if (options.tables.count("context") > 0) measureContextCreation(options.device, repeat, report);
  if (!options.json.empty()) writeResults(head, report.rows(), options.json);
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
