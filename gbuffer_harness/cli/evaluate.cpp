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
#include "common/plot.h"
#include "common/png.h"
#include "reference/reference.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

struct Options {
  std::vector<std::string> captures;
  std::string output, device, picture, plot;
  int box = 4;
  double boxCoverage = 0.5;
  bool reference = false;
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
          {"gather, 8 samples", gather(8)},   {"gather, 16 samples", gather(16)},
          {"gather, 64 samples", gather(64)}};
}

std::string cells(const Comparison& c) {
  char text[128];
  const auto& k = c.channels;
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %+.0f %+.0f %+.0f %%", k[0].relativeRmse,
                k[1].relativeRmse, k[2].relativeRmse, 100 * k[0].bias, 100 * k[1].bias, 100 * k[2].bias);
  return text;
}

std::string compared(const Capture& capture, const Image& image, Subset subset, const Options& options) {
  const auto mask = comparisonMask(capture.material, capture.irradiance, subset);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return "no such pixels | ";
  return cells(compareImages(image, capture.truth->image, mask, options.box, options.boxCoverage));
}

// What the samples converge to, over brute-force diffusion.
Image allTexels(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  reference::Settings settings;
  settings.translucency.gatherSamples = 64;
  settings.diffusion.discardedEnergy = 1e-3;
  return reference::compute(capture, materials, settings).image;
}

// thesis | light-space thickness | gather, 16 samples | truth, under one exposure.
void writePicture(const std::string& path, const Capture& capture,
                  const std::vector<PellucidMaterial>& materials, Replayer& replayer) {
  std::vector<Image> images;
  for (const ReplaySettings& settings : {thesisSettings(), ReplaySettings(), gather(16)})
    images.push_back(rgb(replayer.run(capture, materials, settings).output));
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
    const Image image = rgb(replayer.run(capture, materials, gather(samples)).output);
    const Comparison comparison =
        compareImages(image, capture.truth->image, mask, options.box, options.boxCoverage);
    for (std::size_t c = 0; c < 3; ++c) {
      lines[c].x.push_back(samples);
      lines[c].y.push_back(comparison.channels[c].relativeRmse);
    }
  }
  return lines;
}

void evaluate(const Options& options) {
  Device device({options.device, false});
  Replayer replayer(device);
  std::ostringstream table;
  std::vector<Plot> plots;
  table << "Relative RMSE and mean bias (R G B) against path-traced truth, " << options.box << "x"
        << options.box << " averages of which " << 100 * options.boxCoverage
        << " % and more are surface; unlit: pixels without front irradiance.\n\n"
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
      table << "| " << name << " | " << model.name << " | " << compared(capture, image, Subset::All, options)
            << " | " << compared(capture, image, Subset::Unlit, options) << " |\n";
    }
    if (options.reference) {
      const Image image = allTexels(capture, materials);
      table << "| " << name << " | float64: all texels, exact diffusion | "
            << compared(capture, image, Subset::All, options) << " | "
            << compared(capture, image, Subset::Unlit, options) << " |\n";
    }
    if (!options.picture.empty() && &path == &options.captures.front())
      writePicture(options.picture, capture, materials, replayer);
    if (!options.plot.empty()) {
      Plot plot{name + ", unlit pixels", {"samples", true, {}, {}}, {"relative RMSE", false, 0.0, 0.6}, {}};
      plot.series = samplesAgainstError(name, capture, materials, replayer, options);
      plots.push_back(std::move(plot));
    }
  }
  if (!options.plot.empty()) writePlot(options.plot, plots, 480, 360);
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
  command
      ->add_option("--box-coverage", options->boxCoverage,
                   "part of an average's pixels that must be surface, else it is left out")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--reference", options->reference,
                    "also the float64 gather over all texels with brute-force diffusion; minutes");
  command->add_option("--picture", options->picture,
                      "PNG of the first capture: thesis, light-space thickness, gather, truth");
  command->add_option("--plot", options->plot, "PNG of the error against the samples of the gather");
  command->add_option("--device", options->device, "part of the Vulkan device's name");
  command->callback([options] { evaluate(*options); });
}

}  // namespace pellucid::harness
