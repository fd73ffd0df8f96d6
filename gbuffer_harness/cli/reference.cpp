// `pellucid reference`: the float64 ground truth of a capture, to EXR.
#include "reference/reference.h"
#include "replay/exposure.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "capture/exr.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "common/error.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::string input, output;
  SettingsOptions settings;
  reference::ProfileSource profile = reference::ProfileSource::Material;
  double discardedEnergy = reference::DiffusionSettings{}.discardedEnergy;
  int jobs = 0;
  ManifestPreset preset = ManifestPreset::None;
};

reference::Settings toSettings(const Options& options, const ReplaySettings& replay) {
  const ReplaySettings defaults;
  if (replay.outputFormat != defaults.outputFormat || replay.aliasOutput ||
      replay.renderRect != defaults.renderRect)
    throw UsageError(
        "--set: format, alias and rect say how images are stored; the reference has no use for them");
  reference::Settings settings;
  settings.features = replay.features;
  settings.translucency = replay.translucency;
  settings.debugView = replay.debugView;
  settings.diffusion.source = options.profile;
  settings.diffusion.discardedEnergy = options.discardedEnergy;
  settings.jobs = options.jobs;
  return settings;
}

void runReference(const Options& options) {
  ReplaySettings replay = options.settings.parse();
  toSettings(options, replay);  // what is not of the reference is refused before anything is read
  requireExr("-o", options.output);
  const Capture capture = readCapture(options.input, options.preset);
  const std::vector<PellucidMaterial> compiled = compileMaterials(capture);
  resolveGather(replay, capture, compiled);
  const std::vector<PellucidMaterial> materials = withTransmittance(compiled, replay.transmittance);
  reference::Settings settings = toSettings(options, replay);
  settings.ambient = replay.ambient.value_or(!capture.hiddenIrradiance.empty());
  settings.brightest /= static_cast<double>(preExposureFor(capture));  // as `pellucid replay` has it
  const auto start = std::chrono::steady_clock::now();
  const reference::Result result = reference::compute(capture, materials, settings);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  std::filesystem::path output = options.output;
  if (output.empty()) output = std::filesystem::path(options.input).stem().string() + ".reference.exr";
  writeExr(output, result.image, {"R", "G", "B"},
           {{"pellucid.device", "float64 reference"},
            {"pellucid.capture", capture.name},
            {"pellucid.settings", options.settings.text()},
            {"pellucid.debug", options.settings.debug}});
  if (result.radius > 0)
    std::printf("diffusion cut off at %.4g mm, which leaves out %.2g of the profile's energy at most\n",
                result.radius, result.discardedEnergy);
  std::printf("wrote %s (%.1f s)\n", output.string().c_str(), elapsed.count());
}

}  // namespace

void addReferenceCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand("reference", "Compute a capture's float64 ground truth on the CPU");
  command.option("capture", options->input, "manifest (.json) or EXR with an embedded one").required();
  command.option("-o,--output", options->output, "EXR to write; default: <capture>.reference.exr here");
  addPresetOption(command, options->preset);
  options->settings.addTo(command);
  command.choice(
      "--profile", options->profile,
      {{"material", reference::ProfileSource::Material},
       {"burley", reference::ProfileSource::Burley},
       {"gaussians", reference::ProfileSource::Gaussians}},
      "material (Burley where the material has a distance, else its Gaussians), burley, gaussians");
  command
      .option("--radius-cut", options->discardedEnergy,
              "profile energy that may lie outside of the diffusion's cut-off radius")
      .range(1e-12, 0.5);
  command.option("--jobs", options->jobs, "threads; default: all").range(1, 1024);
  command.run([options] { runReference(*options); });
}

}  // namespace pellucid::harness
