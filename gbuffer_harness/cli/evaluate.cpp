// `pellucid evaluate`: models, or numbers of samples, against the path-traced truth of captures.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/metrics_json.h"
#include "common/compare.h"
#include "common/error.h"
#include "common/plot.h"
#include "common/png.h"
#include "metrics/eye.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

struct EvaluationBoxes {
  int side = 4;           // pixels: averages that are compared
  double coverage = 0.5;  // part of an average's pixels that must be surface
};

// One model's result.
struct Evaluation {
  std::string capture, model;
  std::optional<Comparison> all, unlit;  // absent: no such pixels; unlit: without front irradiance
  EyeMetrics eye;
  // relativeNoise() of the truth over averages as above, wholly of surface, and over 8x8; empty: not known.
  std::vector<double> noise, noiseOf8;
};

using Json = nlohmann::ordered_json;

std::optional<Comparison> compared(const Capture& capture, const Image& result, Subset subset,
                                   const EvaluationBoxes& boxes) {
  const Mask mask = comparisonMask(capture.material, capture.irradiance, subset);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return std::nullopt;
  return compareImages(result, capture.truth->image, mask, boxes.side, boxes.coverage);
}

std::string errorCells(const std::optional<Comparison>& comparison) {
  if (!comparison) return "no such pixels | ";
  char text[128];
  const auto& k = comparison->channels;
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %+.0f %+.0f %+.0f %%", k[0].relativeRmse,
                k[1].relativeRmse, k[2].relativeRmse, 100 * k[0].bias, 100 * k[1].bias, 100 * k[2].bias);
  return text;
}

std::string eyeCells(const EyeMetrics& eye) {
  char text[256];
  const auto& tint = eye.tint.channel;
  const std::string tints = eye.tint.blocks > 0
                                ? (std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %.3f", tint[0], tint[1],
                                                 tint[2], eye.tint.redOverGreen),
                                   text)
                                : "no such blocks | ";
  std::snprintf(text, sizeof text, "%zu (%zu) | %zu | %s | %.3f | %.3f | %.3g", eye.isolated,
                eye.isolatedInTruth, eye.spots, tints.c_str(), eye.flip.mean, eye.flip.p99,
                eye.flip.exposure);
  return text;
}

Json toJson(const std::optional<Comparison>& comparison) {
  if (!comparison) return nullptr;
  Json json;
  for (const ChannelDifference& channel : comparison->channels) {
    json["rel_rmse"].push_back(channel.relativeRmse);
    json["bias"].push_back(channel.bias);
  }
  json["blocks"] = comparison->samples;
  json["nonFinite"] = comparison->nonFiniteA;
  return json;
}

// exposure: of FLIP, as measureFlip(). Throws InputError when sizes differ.
Evaluation evaluate(const std::string& captureName, const std::string& model, const Capture& capture,
                    const Image& result, const EvaluationBoxes& boxes, double exposure) {
  Evaluation e{captureName,
               model,
               compared(capture, result, Subset::All, boxes),
               compared(capture, result, Subset::Unlit, boxes),
               measureEye(result, capture, exposure),
               {},
               {}};
  if (const Truth& truth = *capture.truth; !truth.standardError.empty()) {
    e.noise = relativeNoise(truth.image, truth.standardError, capture.material, boxes.side);
    e.noiseOf8 = relativeNoise(truth.image, truth.standardError, capture.material, 8);
  }
  return e;
}

std::string noiseCells(const std::vector<double>& noise) {
  if (noise.empty()) return "no such block";
  char text[64];
  std::snprintf(text, sizeof text, "%.4f %.4f %.4f", noise[0], noise[1], noise[2]);
  return text;
}

// One row a capture whose truth says its noise.
std::string noiseTable(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  std::ostringstream rows;
  const std::string* last = nullptr;
  for (const Evaluation& e : evaluations) {
    if ((e.noise.empty() && e.noiseOf8.empty()) || (last && *last == e.capture)) continue;
    last = &e.capture;
    rows << "| " << e.capture << " | " << noiseCells(e.noise) << " | " << noiseCells(e.noiseOf8) << " |\n";
  }
  if (rows.str().empty()) return "";
  std::ostringstream text;
  text
      << "\nNoise of the truths: standard error over RMS (R G B), averages wholly of surface.\n\n| capture | "
      << boxes.side << "x" << boxes.side << " | 8x8 |\n|-|-|-|\n"
      << rows.str();
  return text.str();
}

// Tables of error and bias, of what the eye sees, and of the truths' noise where it is known.
std::string evaluationMarkdown(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  std::ostringstream text;
  text << "Relative RMSE and mean bias (R G B) against path-traced truth, " << boxes.side << "x" << boxes.side
       << " averages of which " << 100 * boxes.coverage
       << " % and more are surface; unlit: pixels without front irradiance.\n\n"
       << "| capture | model | all | bias | unlit | bias |\n|-|-|-|-|-|-|\n";
  for (const Evaluation& e : evaluations)
    text << "| " << e.capture << " | " << e.model << " | " << errorCells(e.all) << " | "
         << errorCells(e.unlit) << " |\n";
  text << "\nWhat the eye sees against path-traced truth: isolated pixels (those of the truth in "
          "parentheses), spots that the truth lacks, "
          "tint of 8x8 averages (R G B, then red over green), FLIP.\n\n"
       << "| capture | model | isolated | spots | tint | red/green | FLIP mean | 99th percentile | at "
          "exposure |\n"
       << "|-|-|-|-|-|-|-|-|-|\n";
  for (const Evaluation& e : evaluations)
    text << "| " << e.capture << " | " << e.model << " | " << eyeCells(e.eye) << " |\n";
  text << noiseTable(evaluations, boxes);
  return text.str();
}

// An object with `boxes` and an array of all numbers, one object a result.
std::string evaluationJson(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  Json results = Json::array();
  for (const Evaluation& e : evaluations)
    results.push_back({{"capture", e.capture},
                       {"model", e.model},
                       {"all", toJson(e.all)},
                       {"unlit", toJson(e.unlit)},
                       {"isolated", e.eye.isolated},
                       {"isolatedInTruth", e.eye.isolatedInTruth},
                       {"spots", e.eye.spots},
                       {"tint", toJson(e.eye.tint)},
                       {"flip", toJson(e.eye.flip)},
                       {"truthNoise", e.noise},
                       {"truthNoise8x8", e.noiseOf8}});
  return Json{{"box", boxes.side}, {"boxCoverage", boxes.coverage}, {"results", std::move(results)}}.dump(2) +
         "\n";
}

struct Options {
  std::vector<std::string> captures;
  std::string output, device, picture, plot, rows = "models";
  EvaluationBoxes boxes;
  double exposure = 0;
  bool json = false;
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
  command.option("--picture", options->picture,
                 "PNG of the first capture: thesis, light-space thickness, the default, truth");
  command.option("--plot", options->plot, "PNG of the error against the samples of the gather");
  command.option("--device", options->device, "part of the Vulkan device's name");
  command.run([options] { run(*options); });
}

}  // namespace pellucid::harness
