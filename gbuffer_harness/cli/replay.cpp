// `pellucid replay`: captures through the module on a Vulkan device, to EXR and PNG.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "capture/exr.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/capture_checks.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/plan_json.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/parallel.h"
#include "common/png.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "replay/exposure.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

constexpr const char* kSettingsAttribute = "pellucid.settings";
constexpr const char* kDebugAttribute = "pellucid.debug";
constexpr uint32_t kDefaultRepeat = 3;

struct Options {
  std::string input, output, device, triptych, frames;
  bool png = false, overwrite = false;
  float exposure = 0;
  int jobs = 2;
  std::optional<uint32_t> repeat;
  SettingsOptions settings;
};

void multiply(Image& image, const Image& by) {
  for (size_t i = 0; i < image.data.size() && !by.empty(); ++i) image.data[i] *= by.data[i];
}

void print(const Device& device, const ReplayResult& result, uint32_t repeat) {
  std::printf("%s\n%-22s %-22s %12s %10s %10s\n", device.description().c_str(), "dispatch", "pipeline",
              "groups", "ran", repeat > 0 ? "time us" : "");
  double sum = 0;
  for (uint32_t i = 0; i < result.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = result.plan.dispatches[i];
    const std::string groups =
        std::to_string(d.groups[0]) + "x" + std::to_string(d.groups[1]) + "x" + std::to_string(d.groups[2]);
    std::printf("%-22s %-22s %12s %10llu", d.name, pellucidPipelineName(d.pipeline), groups.c_str(),
                static_cast<unsigned long long>(result.statistics.dispatches[i].run));
    if (repeat > 0) std::printf(" %10.1f", result.times[i].microseconds);
    std::printf("\n");
    if (repeat > 0) sum += result.times[i].microseconds;
  }
  if (repeat > 0)
    std::printf("%-22s %57.1f\ntimes: median of %u %s after a first one, which compiles shaders\n", "all",
                sum, repeat, repeat == 1 ? "frame" : "frames");
  if (const Statistics& s = result.statistics; s.lists)
    std::printf("blocks with material: %llu of %llu\n", static_cast<unsigned long long>(s.blocks.run),
                static_cast<unsigned long long>(s.blocks.most));
  for (uint32_t i = 0; i < result.plan.skipCount; ++i)
    std::printf("skipped: %u x %s (%s)\n", result.plan.skips[i].count, result.plan.skips[i].what,
                result.plan.skips[i].reason);
}

// before | what came through | after
void writeTriptych(const Options& options, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials, ReplaySettings settings,
                   Replayer& replayer, const Image& after, float exposure) {
  // Not the debug view of what the diffusion reads: gathered light is added after it.
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  Capture undiffused = capture;
  undiffused.albedo = {};
  Image through = rgb(replayer.run(undiffused, materials, settings).output);
  Image before = capture.irradiance;
  for (size_t i = 0; i < through.data.size(); ++i)
    through.data[i] = std::max(through.data[i] - before.data[i], 0.0f);
  multiply(through, capture.albedo);
  multiply(before, capture.albedo);
  const Image picture = contactSheet({&before, &through, &after}, 3);
  writePng(options.triptych, picture.width, picture.height, toSrgb(picture, exposure));
  std::printf("wrote %s (before | translucency | after)\n", options.triptych.c_str());
}

bool wantsPng(const Options& options, const ReplaySettings& settings) {
  return options.png || settings.debugView != PELLUCID_DEBUG_NONE;
}

// The PNG comes first: a frame whose EXR is there is finished.
void writeFrame(const Options& options, const std::filesystem::path& output, const Capture& capture,
                const Device& device, const PellucidPlan& plan, const Image& image, bool png, float exposure) {
  if (png)
    writeWhole(std::filesystem::path(output).replace_extension(".png"), [&](const auto& file) {
      writePng(file, image.width, image.height, toSrgb(image, exposure));
    });
  ExrPart part;
  part.attributes = {{"pellucid.device", device.description()},
                     {"pellucid.capture", capture.name},
                     {"pellucid.plan", planJson(plan)},
                     {kSettingsAttribute, options.settings.text()},
                     {kDebugAttribute, options.settings.debug}};
  const char* const names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) part.channels.push_back({names[c], ExrFormat::Float, &image, c});
  writeWhole(output, [&](const auto& file) { writeExrParts(file, {part}); });
}

void replayOne(const Options& options, const ReplaySettings& settings) {
  const Capture capture = readCapture(options.input);
  std::filesystem::path output = options.output;
  if (output.empty()) output = std::filesystem::path(options.input).stem().string() + ".pellucid.exr";
  requireNoInput("-o", output, capture.files);
  if (!options.triptych.empty()) requireNoInput("--triptych", options.triptych, capture.files);
  const std::vector<PellucidMaterial> materials = compileMaterials(capture);
  warn(warningsOf(capture, materials));
  Device device({options.device, false});
  Replayer replayer(device);
  const uint32_t repeat = options.repeat.value_or(kDefaultRepeat);
  const ReplayResult result = replayer.run(capture, materials, settings, repeat);
  print(device, result, repeat);
  if (result.preExposure != 1)
    std::printf(
        "preExposure %g: the largest light is %g, and halves hold at most 65504; the result is free of the "
        "factor\n",
        static_cast<double>(result.preExposure), largestLight(capture));

  const Image image = rgb(result.output);
  const float exposure = options.exposure > 0 ? options.exposure : autoExposure(image);
  const bool png = wantsPng(options, settings);
  writeFrame(options, output, capture, device, result.plan, image, png, exposure);
  std::printf("wrote %s\n", output.string().c_str());
  if (png)
    std::printf("wrote %s (exposure %g)\n",
                std::filesystem::path(output).replace_extension(".png").string().c_str(),
                static_cast<double>(exposure));
  if (!options.triptych.empty())
    writeTriptych(options, capture, materials, settings, replayer, image, exposure);
}

// True of a result that was cut before its images. Headers are sorted by name, so that pellucid.capture is the first attribute of a result. No
// other EXR file has this attribute.
bool isCutResult(const std::filesystem::path& path) {
  try {
    const ExrFile file(path);
    return false;
  } catch (const InputError&) {
    std::ifstream file(path, std::ios::binary);
    std::string begin(4096, 0);
    begin.resize(static_cast<std::size_t>(file.read(begin.data(), 4096).gcount()));
    return begin.find("pellucid.capture") != std::string::npos;
  }
}

// Whether `output` is a whole result of these settings. Throws InputError when it is one of others: a
// sequence must not change its look where it was resumed.
bool isFinished(const Options& options, const std::filesystem::path& output) {
  if (options.overwrite || !std::filesystem::exists(output)) return false;
  if (std::filesystem::file_size(output) == 0 || isCutResult(output)) return false;
  const ExrFile file(output);
  if (!file.findText(kSettingsAttribute))
    throw InputError(output.string(), kSettingsAttribute, "is missing: no result of this command; --overwrite replaces the file");
  const std::string settings = *file.findText(kSettingsAttribute), debug = file.findText(kDebugAttribute).value_or("");
  if (settings == options.settings.text() && debug == options.settings.debug) {
    try {
      readExrImage(output);
      return true;
    } catch (const InputError&) {
      return false;  // damaged: made again
    }
  }
  throw InputError(output.string(), kSettingsAttribute,
                   "made with \"" + settings + (debug.empty() ? "" : " debug=" + debug) +
                       "\" and not with these settings; --overwrite makes it again");
}

// Threads read, compile and write; one at a time has the device. With settings.reuse frames follow in their
// order, each with the history of the one before.
void replaySequence(const Options& options, const ReplaySettings& settings) {
  const FramePattern input("capture", options.input), output("-o", options.output);
  const std::vector<int> frames = options.frames.empty() ? input.existing() : parseFrames(options.frames);
  if (frames.empty()) throw InputError(options.input, "", "no file has such a name");
  const bool keepsHistory = settings.reuse != PELLUCID_REUSE_NONE;
  if (keepsHistory && !options.overwrite)
    for (const int frame : frames)
      if (std::filesystem::exists(output(frame)))
        throw InputError(output(frame).string(), "",
                         "is there, but frames with reuse need the history of those before: --overwrite "
                         "makes all of them again");
  Device device({options.device, false});
  Replayer replayer(device);
  ReplaySequence sequence(device);
  Progress progress("replaying", frames.size());
  std::mutex deviceMutex, reportMutex;
  std::map<int, std::string> failures;
  std::map<std::string, std::string> warnings;  // by the sentence without numbers: frames have most in common
  std::vector<int> missing;
  int skipped = 0;
  const auto counted = [&](const auto& change) {
    const std::scoped_lock lock(reportMutex);
    change();
  };
  const auto replayFrame = [&](int frame) {
    if (isFinished(options, output(frame))) return counted([&] { ++skipped; });
    if (!std::filesystem::exists(input(frame))) return counted([&] { missing.push_back(frame); });
    const Capture capture = readCapture(input(frame));
    requireNoInput("-o", output(frame), capture.files);
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    std::vector<std::string> sentences = warningsOf(capture, materials);
    if (settings.reuse == PELLUCID_REUSE_ACCUMULATE && capture.motion.empty())
      sentences.push_back("without the buffer \"motion\" all that a capture shows counts as still");
    counted([&] {
      for (const std::string& sentence : sentences) {
        std::string kind = sentence;
        std::erase_if(kind, [](char c) { return std::string_view("0123456789.+-e").find(c) != std::string_view::npos; });
        warnings.emplace(kind, "frame " + std::to_string(frame) + ": " + sentence);
      }
    });
    std::unique_lock lock(deviceMutex);
    const ReplayResult replayed = keepsHistory ? sequence.run(capture, materials, settings)
                                               : replayer.run(capture, materials, settings);
    lock.unlock();
    writeFrame(options, output(frame), capture, device, replayed.plan, rgb(replayed.output),
               wantsPng(options, settings), options.exposure);
  };
  const auto tryFrame = [&](int frame) {
    try {
      replayFrame(frame);
    } catch (const DeviceError&) {
      throw;  // the next frame would find the same device
    } catch (const std::bad_alloc&) {
      counted([&] { failures[frame] = "needs more memory than there is"; });
    } catch (const std::exception& error) {
      counted([&] { failures[frame] = error.what(); });
    }
    progress.advance();
  };
  if (keepsHistory) {
    std::size_t lost = 0;  // frames that are missing or failed
    for (std::size_t i = 0; i < frames.size(); ++i) {
      tryFrame(frames[i]);
      // Motion vectors lead to the frame before, whose history there must be.
      const bool isLost = missing.size() + failures.size() > lost;
      lost = missing.size() + failures.size();
      if (isLost || (i + 1 < frames.size() && frames[i + 1] != frames[i] + 1)) sequence.cut();
    }
  } else {
    parallelRows(static_cast<int>(frames.size()), options.jobs,
                 [&](int i) { tryFrame(frames[static_cast<std::size_t>(i)]); });
  }
  for (const auto& [kind, sentence] : warnings) warn({sentence});
  const std::size_t failedCount = failures.size() + missing.size();
  std::printf("%s\n%zu frames: %zu written, %d finished before, %zu failed\n", device.description().c_str(),
              frames.size(), frames.size() - static_cast<std::size_t>(skipped) - failedCount, skipped,
              failedCount);
  if (failedCount == 0) return;
  std::sort(missing.begin(), missing.end());
  std::string report;
  std::vector<int> failed = missing;
  if (!missing.empty()) report = "\n  frames " + framesText(missing) + ": " + options.input + " is not there";
  for (const auto& [frame, sentence] : failures) {
    report += "\n  frame " + std::to_string(frame) + ": " + sentence;
    failed.push_back(frame);
  }
  std::sort(failed.begin(), failed.end());
  throw std::runtime_error("failed: --frames " + framesText(failed) + report);  // of many sentences
}

void replay(const Options& options) {
  const ReplaySettings settings = options.settings.parse();
  requireExr("-o", options.output);
  if (!options.triptych.empty() && settings.debugView != PELLUCID_DEBUG_NONE)
    throw UsageError("--triptych shows results and cannot be combined with --debug");
  const bool isSequence = !options.frames.empty() || (options.input.find('#') != std::string::npos &&
                                                      !std::filesystem::exists(options.input));
  if (!isSequence) {
    return withinMemory(options.input, [&] { replayOne(options, settings); });
  }
  if (!options.triptych.empty()) throw UsageError("--triptych shows one capture, not a sequence");
  if (options.repeat) throw UsageError("--repeat times one capture, not a sequence");
  if (options.output.empty()) throw UsageError("a sequence: -o with #### is required");
  if (wantsPng(options, settings) && !(options.exposure > 0))
    throw UsageError("a sequence: PNGs need --exposure, one for the whole");
  replaySequence(options, settings);
}

}  // namespace

void addReplayCommand(const Command& app) {
  auto options = std::make_shared<Options>();
  const Command command = app.subcommand("replay", "Run captures through the module on a Vulkan device");
  command
      .option("capture", options->input,
              "manifest (.json) or EXR with an embedded one; of a sequence name.####.exr")
      .required();
  command.option("-o,--output", options->output,
                 "EXR to write; default: <capture>.pellucid.exr here; of a sequence out.####.exr");
  command.option("--frames", options->frames,
                 "of a sequence: FIRST-LAST or a list like 1-10,20 (default: all that exist); frames "
                 "finished before are skipped, without reuse");
  command.option("--jobs", options->jobs, "threads of a sequence that read and write files").range(1, 1024);
  command.flag("--overwrite", options->overwrite, "of a sequence: make finished frames again");
  command
      .option("--repeat", options->repeat,
              "frames that are timed, after a first one that compiles shaders: the median is printed; 0: "
              "no times; default: 3, not of a sequence")
      .range(0, 1000);
  command.flag("--png", options->png, "also write a PNG beside the EXR (--debug always does)");
  command.option("--triptych", options->triptych, "write a PNG of before | translucency | after");
  command.option("--exposure", options->exposure, "factor for PNGs; default: from the picture").positive();
  command.option("--device", options->device, "part of the Vulkan device's name; default: the fastest kind");
  options->settings.addTo(command);
  command.run([options] { replay(*options); });
}

}  // namespace pellucid::harness
