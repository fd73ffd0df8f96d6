// `pellucid evaluate`: models, or numbers of samples, against the path-traced truth of captures.
#include <cstdio>
#include <fstream>

#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/evaluate_report.h"
#include "common/compare.h"
#include "common/error.h"
#include "common/plot.h"
#include "common/png.h"
#include "reference/reference.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::vector<std::string> captures;
  std::string output, device, picture, plot, rows = "models";
  EvaluationBoxes boxes;
  double exposure = 0;
  bool reference = false, json = false;
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

Image replayed(Replayer& replayer, const Capture& capture, const std::vector<PellucidMaterial>& materials,
               ReplaySettings settings) {
  settings.preExposure = 0;  // as `pellucid replay` has it
  return rgb(replayer.run(capture, materials, settings).output);
}

// What the samples converge to, over brute-force diffusion.
Image allTexels(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  reference::Settings settings;
  settings.translucency.gatherSamples = 64;
  settings.diffusion.discardedEnergy = 1e-3;
  return reference::compute(capture, materials, settings).image;
}

// thesis | light-space thickness | the default | truth, under one exposure.
void writePicture(const std::string& path, const Capture& capture,
                  const std::vector<PellucidMaterial>& materials, Replayer& replayer) {
  std::vector<Image> images;
  for (const ReplaySettings& settings : {thesisSettings(), ReplaySettings(), gather(kDefaultGatherSamples)})
    images.push_back(replayed(replayer, capture, materials, settings));
  images.push_back(capture.truth->image);
  std::vector<const Image*> pointers;
  for (Image& image : images) {
    for (std::size_t i = 0; i < capture.material.size(); ++i)
      if (capture.material[i] == 0) std::fill_n(&image.data[3 * i], 3, 0.0f);
    pointers.push_back(&image);
  }
  const Image picture = contactSheet(pointers, static_cast<int>(images.size()));
  writePng(path, picture.width, picture.height, toSrgb(picture, autoExposure(images.back())));
}

// Relative RMSE of the unlit pixels against samples, one line a capture and channel.
std::vector<Series> samplesAgainstError(const std::string& name, const Capture& capture,
                                        const std::vector<PellucidMaterial>& materials, Replayer& replayer,
                                        const Options& options) {
  const auto mask = comparisonMask(capture.material, capture.irradiance, Subset::Unlit);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return {};
  std::vector<Series> lines(3);
  constexpr Color colors[] = {{200, 40, 40}, {40, 140, 60}, {50, 80, 200}};
  for (std::size_t c = 0; c < 3; ++c) {
    lines[c].color = colors[c];
    lines[c].name = name + std::string(" ") + "RGB"[c];
  }
  for (const std::uint32_t samples : {4u, 8u, 16u, 32u, 64u}) {
    const Image image = replayed(replayer, capture, materials, gather(samples));
    const Comparison comparison =
        compareImages(image, capture.truth->image, mask, options.boxes.side, options.boxes.coverage);
    for (std::size_t c = 0; c < 3; ++c) {
      lines[c].x.push_back(samples);
      lines[c].y.push_back(comparison.channels[c].relativeRmse);
    }
  }
  return lines;
}

void run(const Options& options) {
  Device device({options.device, false});
  Replayer replayer(device);
  std::vector<Evaluation> evaluations;
  std::vector<Plot> plots;
  for (const std::string& path : options.captures) {
    const Capture capture = readCapture(path);
    if (!capture.truth) throw InputError(path, "truth", "missing: there is nothing to evaluate against");
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const auto file = std::filesystem::absolute(path);
    const std::string name =
        file.extension() == ".json" ? file.parent_path().filename().string() : file.stem().string();
    const auto add = [&](const std::string& model, const Image& image) {
      evaluations.push_back(evaluate(name, model, capture, image, options.boxes, options.exposure));
    };
    for (const Model& model : options.rows == "models" ? models() : samples())
      add(model.name, replayed(replayer, capture, materials, model.settings));
    if (options.reference) add("float64: all texels, exact diffusion", allTexels(capture, materials));
    if (!options.picture.empty() && &path == &options.captures.front())
      writePicture(options.picture, capture, materials, replayer);
    if (!options.plot.empty()) {
      Plot plot{name + ", unlit pixels", {"samples", true, {}, {}}, {"relative RMSE", false, 0.0, 0.6}, {}};
      plot.series = samplesAgainstError(name, capture, materials, replayer, options);
      plots.push_back(std::move(plot));
    }
  }
  if (!options.plot.empty()) writePlot(options.plot, plots, 480, 360);
  const std::string report = options.json ? evaluationJson(evaluations, options.boxes)
                                          : evaluationMarkdown(evaluations, options.boxes);
  if (options.output.empty()) {
    std::fputs(report.c_str(), stdout);
    return;
  }
  std::ofstream file(options.output);
  file << report;
  if (!file.flush()) throw InputError(options.output, "", "cannot be written");
}

}  // namespace

void addEvaluateCommand(const Command& app) {
  auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("evaluate", "Compare translucency models or numbers of samples with captures' truth");
  command.option("captures", options->captures, "captures with truth").required();
  command.option("-o,--output", options->output, "file to write the tables to; default: standard output");
  command.option("--rows", options->rows, "models, or samples: 0, 8 and 16 of the gather")
      .oneOf({"models", "samples"});
  command.flag("--json", options->json, "JSON instead of Markdown tables");
  command
      .option("--exposure", options->exposure,
              "factor for FLIP; default: brings the truth's 99th percentile to 0.8")
      .positive();
  command.option("--box", options->boxes.side, "average NxN pixels first").range(1, 64);
  command
      .option("--box-coverage", options->boxes.coverage,
              "part of an average's pixels that must be surface, else it is left out")
      .range(0.0, 1.0);
  command.flag("--reference", options->reference,
               "add the float64 gather over all texels with brute-force diffusion; takes minutes");
  command.option("--picture", options->picture,
                 "PNG of the first capture: thesis, light-space thickness, the default, truth");
  command.option("--plot", options->plot, "PNG of the error against the samples of the gather");
  command.option("--device", options->device, "part of the Vulkan device's name");
  command.run([options] { run(*options); });
}

}  // namespace pellucid::harness
