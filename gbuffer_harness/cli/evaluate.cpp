// `pellucid evaluate`: models, or numbers of samples, against the path-traced truth of captures.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "common/compare.h"
#include "common/error.h"
#include "metrics/eye.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

// One model's result.
struct Evaluation {
  std::string capture, model;
  std::optional<Comparison> all, unlit;  // absent: no such pixels; unlit: without front irradiance
  EyeMetrics eye;
};

std::optional<Comparison> compared(const Capture& capture, const Image& result, Subset subset) {
  const Mask mask = comparisonMask(capture.material, capture.irradiance, subset);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return std::nullopt;
  return compareImages(result, capture.truth->image, mask, kTruthBox);
}

std::string errorCells(const std::optional<Comparison>& comparison) {
  if (!comparison) return "no such pixels | ";
  char text[128];
  const auto& k = comparison->channels;
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %+.0f %+.0f %+.0f %%", k[0].relativeRmse,
                k[1].relativeRmse, k[2].relativeRmse, 100 * k[0].bias, 100 * k[1].bias, 100 * k[2].bias);
  return text;
}

std::string tintCells(const Tint& tint) {
  if (tint.blocks == 0) return "no such blocks | ";
  char text[64];
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %.3f", tint.channel[0], tint.channel[1], tint.channel[2],
                tint.redOverGreen);
  return text;
}

void print(const std::vector<Evaluation>& evaluations) {
  std::printf(
      "Relative RMSE and mean bias (R G B) against the truth, %dx%d averages of which half and more are "
      "surface; "
      "unlit: pixels without front irradiance.\n\n"
      "| capture | model | all | bias | unlit | bias |\n|-|-|-|-|-|-|\n",
      kTruthBox, kTruthBox);
  for (const Evaluation& e : evaluations)
    std::printf("| %s | %s | %s | %s |\n", e.capture.c_str(), e.model.c_str(), errorCells(e.all).c_str(),
                errorCells(e.unlit).c_str());
  std::printf(
      "\nWhat the eye sees against the truth: isolated pixels (those of the truth in parentheses), spots "
      "that the truth "
      "lacks, tint of 8x8 averages (R G B, then red over green), FLIP.\n\n"
      "| capture | model | isolated | spots | tint | red/green | FLIP mean | 99th percentile |\n"
      "|-|-|-|-|-|-|-|-|\n");
  for (const auto& [capture, model, all, unlit, eye] : evaluations) {
    std::printf("| %s | %s | %zu (%zu) | %zu | %s | %.3f | %.3f |\n", capture.c_str(), model.c_str(),
                eye.isolated, eye.isolatedInTruth, eye.spots, tintCells(eye.tint).c_str(), eye.flip.mean,
                eye.flip.p99);
  }
}

struct Options {
  std::vector<std::string> captures;
  std::string device, rows = "models";
};

struct Model {
  std::string name;
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
  camera.translucency.cameraThickness = true;
  return {{"no translucency", none},          {"thesis", thesisSettings()},
          {"camera-space thickness", camera}, {"light-space thickness", light},
          {"gather, 8 samples", gather(8)},   {"gather, 16 samples", gather(16)},
          {"gather, 64 samples", gather(64)}};
}

std::vector<Model> samples() {
  std::vector<Model> all;
  for (const std::uint32_t count : {0u, kDefaultGatherSamples, 16u})
    all.push_back({std::to_string(count) + " samples", gather(count)});
  return all;
}

void run(const Options& options) {
  Device device({options.device, false});
  Replayer replayer(device);
  std::vector<Evaluation> evaluations;
  for (const std::string& path : options.captures) {
    const Capture capture = readCapture(path);
    if (!capture.truth) throw InputError(path, "truth", "missing: there is nothing to evaluate against");
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const Mask mask = comparisonMask(capture.material, capture.irradiance, Subset::All);
    const auto file = std::filesystem::absolute(path);
    const std::string name =
        file.extension() == ".json" ? file.parent_path().filename().string() : file.stem().string();
    for (const Model& model : options.rows == "models" ? models() : samples()) {
      ReplaySettings settings = model.settings;
      settings.preExposure = 0;  // as `pellucid replay` has it
      const Image image = rgb(replayer.run(capture, materials, settings).output);
      evaluations.push_back({name, model.name, compared(capture, image, Subset::All),
                             compared(capture, image, Subset::Unlit),
                             measureEye(image, capture.truth->image, mask, &capture)});
    }
  }
  print(evaluations);
}

}  // namespace

void addEvaluateCommand(const Command& app) {
  auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("evaluate", "Compare translucency models or numbers of samples with captures' truth");
  command.option("captures", options->captures, "captures with truth").required();
  command.option("--rows", options->rows, "models, or samples: 0, 8 and 16 of the gather")
      .oneOf({"models", "samples"});
  command.option("--device", options->device, "part of the Vulkan device's name");
  command.run([options] { run(*options); });
}

}  // namespace pellucid::harness
