// `pellucid evaluate`: every model against the path-traced truth of captures, as a Markdown table.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "common/compare.h"
#include "common/error.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::vector<std::string> captures;
  std::string output, device;
  int box = 4;
};

struct Model {
  const char* name;
  ReplaySettings settings;
};

ReplaySettings gather(std::uint32_t samples) {
  ReplaySettings s;
  s.translucency.gatherSamples = samples;
  return s;
}

std::vector<Model> models() {
  ReplaySettings none, light, camera;
  none.features = PELLUCID_FEATURE_DIFFUSION;
  camera.translucency.thicknessSource = PELLUCID_THICKNESS_CAMERA;
  camera.translucency.shadowBias = thesisSettings().translucency.shadowBias;
  return {{"no translucency", none},          {"thesis", thesisSettings()},
          {"camera-space thickness", camera}, {"light-space thickness", light},
          {"gather, 16 samples", gather(16)}, {"gather, 64 samples", gather(64)}};
}

std::string cells(const Comparison& c) {
  char text[128];
  const auto& k = c.channels;
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %+.0f %+.0f %+.0f %%", k[0].relativeRmse,
                k[1].relativeRmse, k[2].relativeRmse, 100 * k[0].bias, 100 * k[1].bias, 100 * k[2].bias);
  return text;
}

std::string compared(const Capture& capture, const Image& image, Subset subset, int box) {
  const auto mask = comparisonMask(capture.material, capture.irradiance, subset);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return "no such pixels | ";
  return cells(compareImages(image, capture.truth->image, mask, box));
}

void evaluate(const Options& options) {
  Device device({options.device, false});
  Replayer replayer(device);
  std::ostringstream table;
  table << "Relative RMSE and mean bias (R G B) against path-traced truth, " << options.box << "x"
        << options.box << " averages; unlit: pixels without front irradiance.\n\n"
        << "| capture | model | all | bias | unlit | bias |\n|-|-|-|-|-|-|\n";
  for (const std::string& path : options.captures) {
    const Capture capture = readCapture(path);
    if (!capture.truth) throw InputError(path, "truth", "missing: there is nothing to evaluate against");
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const auto file = std::filesystem::absolute(path);
    const std::string name =
        file.extension() == ".json" ? file.parent_path().filename().string() : file.stem().string();
    for (const Model& model : models()) {
      const Image image = rgb(replayer.run(capture, materials, model.settings).output);
      table << "| " << name << " | " << model.name << " | "
            << compared(capture, image, Subset::All, options.box) << " | "
            << compared(capture, image, Subset::Unlit, options.box) << " |\n";
    }
  }
  if (options.output.empty()) {
    std::fputs(table.str().c_str(), stdout);
    return;
  }
  std::ofstream file(options.output);
  file << table.str();
  if (!file.flush()) throw InputError(options.output, "", "cannot be written");
}

}  // namespace

void addEvaluateCommand(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Compare every translucency model with captures' truth, as a table");
  command->add_option("captures", options->captures, "captures with truth")->required();
  command->add_option("-o,--output", options->output, "Markdown file; default: standard output");
  command->add_option("--box", options->box, "average NxN pixels first")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--device", options->device, "part of the Vulkan device's name");
  command->callback([options] { evaluate(*options); });
}

}  // namespace pellucid::harness
