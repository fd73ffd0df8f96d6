// `pellucid stress`: random frames through the module, and what must hold for each.
#include "cli/stress.h"

#include <cstdio>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>

#include "capture/write.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/guarded_memory.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "stress/stress.h"

namespace pellucid::harness {
namespace {

using stress::StressFrame;
using stress::StressOptions;
using stress::StressResult;
using stress::Violation;

// Violations of a check that are printed, tame and wild apart: what comes later adds little.
constexpr int kShown = 3;

struct Options {
  StressOptions stress;
  std::string device, folder;
  bool guarded = false;
};

std::string kindOf(const StressFrame& frame) { return frame.wild ? "wild" : "tame"; }

// The command that runs one frame again.
std::string againText(const Options& options, std::uint64_t frame) {
  const StressOptions defaults, &given = options.stress;
  std::string text = "pellucid stress --seed " + std::to_string(given.seed) + " --first " +
                     std::to_string(frame) + " --frames 1";
  if (given.limits.pixels != defaults.limits.pixels)
    text += " --pixels " + std::to_string(given.limits.pixels);
  if (given.validate) text += " --validate";
  if (options.guarded) text += " --guarded";
  return text;
}

class Reporter {
public:
  explicit Reporter(const Options& options) : options_(options) {}

  void operator()(const StressFrame& frame, const std::vector<Violation>& violations) {
    bool shown = false;
    for (const Violation& v : violations) {
      if (++count_[kindOf(frame) + v.check] > kShown) continue;
      shown = true;
      std::printf("%s frame %llu: %s: %g", kindOf(frame).c_str(),
                  static_cast<unsigned long long>(frame.index), v.check.c_str(), v.worst.value);
      if (v.worst.x >= 0) std::printf(" at pixel %d, %d, channel %d", v.worst.x, v.worst.y, v.worst.channel);
      std::printf("%s%s\n", v.sentence.empty() ? "" : ": ", v.sentence.c_str());
    }
    if (!shown) return;
    std::printf("  again: %s\n", againText(options_, frame.index).c_str());
    if (!options_.folder.empty()) {
      std::printf("  or:    %s\n", writeFailure(options_.folder, frame).c_str());
      if (!frame.notInCapture.empty())
        std::printf("         (the capture lacks %s)\n", frame.notInCapture.c_str());
    }
    std::fflush(stdout);
  }

private:
  const Options& options_;
  std::map<std::string, int> count_;
};

template <class... Cell>
void printRow(const std::string& name, const Cell&... cells) {
  std::cout << std::left << std::setw(18) << name << std::right << std::setprecision(2);
  ((std::cout << std::setw(11) << cells), ...);
  std::cout << '\n';
}

void print(const StressOptions& options, const StressResult& result) {
  std::cout << result.device << "\nseed " << options.seed << ", frames " << options.first << " to "
            << options.first + result.frames - 1 << ", " << result.recordings << " recordings, "
            << result.pixels << " pixels, " << std::fixed << std::setprecision(1) << result.seconds
            << std::defaultfloat << " s; refused: " << result.refusedTame << " tame, " << result.refusedWild
            << " wild\n";
  printRow("check", "tame", "violated", "worst", "frame", "wild", "violated", "worst", "frame");
  for (const auto& [name, tame, wild] : result.checks)
    printRow(name, tame.done, tame.violations, tame.worst.value, tame.worstFrame, wild.done, wild.violations,
             wild.worst.value, wild.worstFrame);
}

void run(Options& options) {
  StressOptions& s = options.stress;
  // Errors of these options come before a device is opened.
  if (!s.only.empty()) stress::requireCheck(s.only);
  DeviceOptions wanted{options.device, s.validate};
  wanted.guarded = options.guarded;
  stress::Renderer renderer(wanted);
  Reporter reporter(options);
  stress::StressEvents events;
  if (options.guarded)
    events.started = [&](std::uint64_t frame) { reportGuardFaults(againText(options, frame).c_str()); };
  events.violated = [&](const StressFrame& frame, const std::vector<Violation>& violations) {
    reporter(frame, violations);
  };
  StressResult result;
  {
    // Hundredths of a second, or frames.
    Progress progress("stressing", s.frames ? *s.frames : static_cast<std::uint64_t>(100 * s.seconds));
    std::uint64_t shown = 0;
    events.progressed = [&](const StressResult& sofar) {
      const std::uint64_t done =
          s.frames ? sofar.frames : static_cast<std::uint64_t>(100 * std::min(sofar.seconds, s.seconds));
      progress.note(std::to_string(sofar.frames) + " frames, " + std::to_string(sofar.violations()) +
                    " violations");
      progress.advance(done - shown);
      shown = done;
    };
    result = stress::runStress(renderer, s, events);
  }
  print(s, result);
  if (result.violations() > 0) throw LimitExceeded(std::to_string(result.violations()) + " violations");
}

}  // namespace

std::string writeFailure(const std::filesystem::path& folder, const stress::StressFrame& frame) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path exr = folder / (frame.capture.name + ".exr"),
                              json = folder / (frame.capture.name + ".json");
  Capture capture = frame.capture;
  capture.irradiance = rgb(capture.irradiance);
  if (const std::uint32_t mark = frame.settings.translucency.materialMarkBit)
    for (std::uint8_t& m : capture.material) m = static_cast<std::uint8_t>(m & ~mark);
  writeCapture(capture, exr);
  ReplaySettings settings = frame.settings;
  settings.transmittance = frame.transmittance;
  writeWholeText(json, settingsJson(settings));
  const std::string debug = debugOption(settings);
  return "pellucid replay " + exr.string() + " --set @" + json.string() +
         (debug.empty() ? "" : " --debug " + debug);
}

void addStressCommand(const Command& app) {
  auto options = std::make_shared<Options>();
  StressOptions& s = options->stress;
  const Command command = app.subcommand(
      "stress", "Random frames through the module on a Vulkan device, and what must hold for each");
  const CommandOption seconds = command.option("--seconds", s.seconds, "how long").range(0.0, 1e6);
  command.option("--frames", s.frames, "how many frames, in place of --seconds")
      .range(1, 1000000000)
      .excludes(seconds);
  command.option("--seed", s.seed, "of all frames");
  command.option("--first", s.first, "index of the first frame; even ones are tame, odd ones wild");
  command.option("--pixels", s.limits.pixels, "of the largest frame").range(16, 1 << 26);
  command.option("--only", s.only, "one check by its name; CONTRIBUTING.md has them");
  command.flag("--validate", s.validate,
               "with Vulkan's core and synchronization validation, whose messages are violations");
  command.flag(
      "--guarded", options->guarded,
      "constants in memory that ends at pages without access, and transients that hold 0xFF or what looks "
      "like indices: an access beyond the constants ends the command");
  command.option("-o,--output", options->folder, "folder for captures of frames that violate a check");
  command.option("--device", options->device, "part of the Vulkan device's name; default: the fastest kind");
  command.run([options] { run(*options); });
}

}  // namespace pellucid::harness
