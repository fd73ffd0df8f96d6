// `pellucid replay`: a capture through the module on a Vulkan device, to EXR and PNG.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "capture/exr.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/plan_text.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/png.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::string input, output, device, triptych;
  bool png = false;
  float exposure = 0;
  SettingsOptions settings;
};

void multiply(Image& image, const Image& by) {
  for (size_t i = 0; i < image.data.size() && !by.empty(); ++i) image.data[i] *= by.data[i];
}

// Brings the 99th percentile of the lit values to 0.8: below white, above the middle.
float autoExposure(const Image& image) {
  std::vector<float> lit;
  for (float v : image.data)
    if (v > 0 && v < 1e30f) lit.push_back(v);
  if (lit.empty()) return 1;
  const auto nth = lit.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(lit.size() - 1) * 0.99);
  std::nth_element(lit.begin(), nth, lit.end());
  return 0.8f / *nth;
}

void print(const Device& device, const ReplayResult& result) {
  std::printf("%s\n%-22s %-22s %12s %14s %10s\n", device.description().c_str(), "dispatch", "pipeline",
              "groups", "modeled bytes", "time us");
  for (uint32_t i = 0; i < result.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = result.plan.dispatches[i];
    const std::string groups =
        std::to_string(d.groups[0]) + "x" + std::to_string(d.groups[1]) + "x" + std::to_string(d.groups[2]);
    std::printf("%-22s %-22s %12s %14llu %10.1f\n", d.name, pellucidPipelineName(d.pipeline), groups.c_str(),
                static_cast<unsigned long long>(d.modeledBytes), result.times[i].microseconds);
  }
  for (uint32_t i = 0; i < result.plan.skipCount; ++i)
    std::printf("skipped: %u x %s (%s)\n", result.plan.skips[i].count, result.plan.skips[i].what,
                result.plan.skips[i].reason);
}

// before | what came through | after
void writeTriptych(const Options& options, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials, ReplaySettings settings,
                   Replayer& replayer, const Image& after, float exposure) {
  settings.debugView = PELLUCID_DEBUG_IRRADIANCE;
  Image through = rgb(replayer.run(capture, materials, settings).output);
  Image before = capture.irradiance;
  for (size_t i = 0; i < through.data.size(); ++i)
    through.data[i] = std::max(through.data[i] - before.data[i], 0.0f);
  multiply(through, capture.albedo);
  multiply(before, capture.albedo);
  const Image picture = sideBySide({&before, &through, &after});
  writePng(options.triptych, picture.width, picture.height, toSrgb(picture, exposure));
  std::printf("wrote %s (before | translucency | after)\n", options.triptych.c_str());
}

void replay(const Options& options) {
  const ReplaySettings settings = options.settings.parse();
  if (!options.triptych.empty() && settings.debugView != PELLUCID_DEBUG_NONE)
    throw UsageError("--triptych shows results and cannot be combined with --debug");
  const Capture capture = readCapture(options.input);
  const std::vector<PellucidMaterial> materials = compileMaterials(capture);
  Device device({options.device, false});
  Replayer replayer(device);
  const ReplayResult result = replayer.run(capture, materials, settings);
  print(device, result);

  std::filesystem::path output = options.output;
  if (output.empty()) output = std::filesystem::path(options.input).stem().string() + ".pellucid.exr";
  const Image image = rgb(result.output);
  writeExr(output, image, {"R", "G", "B"},
           {{"pellucid.device", device.description()},
            {"pellucid.capture", capture.name},
            {"pellucid.plan", planJson(result.plan)},
            {"pellucid.settings", options.settings.text()},
            {"pellucid.debug", options.settings.debug}});
  std::printf("wrote %s\n", output.string().c_str());
  const float exposure = options.exposure > 0 ? options.exposure : autoExposure(image);
  if (options.png || settings.debugView != PELLUCID_DEBUG_NONE) {
    const std::string png = std::filesystem::path(output).replace_extension(".png").string();
    writePng(png, image.width, image.height, toSrgb(image, exposure));
    std::printf("wrote %s (exposure %g)\n", png.c_str(), static_cast<double>(exposure));
  }
  if (!options.triptych.empty())
    writeTriptych(options, capture, materials, settings, replayer, image, exposure);
}

}  // namespace

void addReplayCommand(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("replay", "Run a capture through the module on a Vulkan device");
  command->add_option("capture", options->input, "manifest (.json) or EXR with an embedded one")->required();
  command->add_option("-o,--output", options->output, "EXR to write; default: <capture>.pellucid.exr here");
  command->add_flag("--png", options->png, "also write a PNG beside the EXR (--debug always does)");
  command->add_option("--triptych", options->triptych, "write a PNG of before | translucency | after");
  command->add_option("--exposure", options->exposure, "factor for PNGs; default: from the picture")
      ->check(CLI::PositiveNumber);
  command->add_option("--device", options->device,
                      "part of the Vulkan device's name; default: the fastest kind");
  options->settings.addTo(*command);
  command->callback([options] { replay(*options); });
}

}  // namespace pellucid::harness
