// pellucid_diffusion_error: the module's diffusion against the float64 reference, every pixel against every
// other, over radii and scenes: the tables of docs/diffusion.md and of module/src/diffusion_error_table.h.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "common/compare.h"
#include "common/error.h"
#include "diffusion_error_table.h"
#include "pellucid/pellucid_material.h"
#include "reference/reference.h"
#include "replay/replay.h"
#include "scene.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;

// The largest channel's.
double relativeRmse(const Image& image, const Image& truth, const std::vector<std::uint8_t>& pixels) {
  const Comparison c = compareImages(image, truth, pixels);
  double worst = 0;
  for (const ChannelDifference& k : c.channels) worst = std::max(worst, k.relativeRmse);
  return worst;
}

struct Bench {
  Device device;
  Context context;
  int size, pixels;

  Bench(const std::string& deviceName, int side, int errorPixels)
      : device({deviceName, false}), context(device), size(side), pixels(errorPixels) {}

  // Of each quality, at a radius in pixels.
  std::vector<double> errors(const ErrorScene& scene, double radius, const std::vector<uint32_t>& qualities) {
    const Capture capture = makeErrorCapture(scene, size, 1);
    const PellucidMaterial material = burleyMaterial(radius);
    reference::Settings settings;
    settings.features = PELLUCID_FEATURE_DIFFUSION;
    settings.wanted = spreadPixels(capture, pixels);
    const Image truth = reference::compute(capture, {material}, settings).image;
    std::vector<double> result;
    for (const uint32_t quality : qualities) {
      ReplaySettings replaySettings;
      replaySettings.features = PELLUCID_FEATURE_DIFFUSION;
      replaySettings.quality = quality;
      FrameRun run(device, context, capture, {material}, replaySettings);
      device.run([&](VkCommandBuffer c) { run.record(c); });
      result.push_back(relativeRmse(rgb(run.output()), truth, settings.wanted));
    }
    return result;
  }

  // Of the worst scene.
  std::vector<double> worst(double radius, const std::vector<uint32_t>& qualities) {
    std::vector<double> most(qualities.size());
    for (const ErrorScene& scene : errorScenes()) {
      const std::vector<double> all = errors(scene, radius, qualities);
      std::transform(all.begin(), all.end(), most.begin(), most.begin(),
                     [](double a, double b) { return std::max(a, b); });
    }
    return most;
  }
};

void printScenes(Bench& bench, const std::vector<double>& radii, uint32_t quality) {
  std::printf("| scene, %d x %d pixels |", bench.size, bench.size);
  for (const double radius : radii) std::printf(" %g px |", radius);
  std::printf("\n|-|");
  for (size_t i = 0; i < radii.size(); ++i) std::printf("-|");
  std::printf("\n");
  for (const ErrorScene& scene : errorScenes()) {
    std::printf("| %s |", scene.title.c_str());
    for (const double radius : radii) {
      std::printf(" %.4f |", bench.errors(scene, radius, {quality})[0]);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

// One quality of each row of the table, without and with the fine filter.
const std::vector<uint32_t> kQualities = {0, 1};

// Root mean squares over the scenes, a row for each quality.
void printMeans(Bench& bench, const std::vector<double>& radii) {
  std::vector<std::vector<double>> rows(kQualities.size());
  for (const double radius : radii) {
    std::vector<double> squares(kQualities.size());
    for (const ErrorScene& scene : errorScenes()) {
      const std::vector<double> all = bench.errors(scene, radius, kQualities);
      for (size_t i = 0; i < all.size(); ++i) squares[i] += all[i] * all[i];
    }
    for (size_t i = 0; i < squares.size(); ++i)
      rows[i].push_back(std::sqrt(squares[i] / static_cast<double>(errorScenes().size())));
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    std::printf("| quality %u |", kQualities[i]);
    for (const double mean : rows[i]) std::printf(" %.5f |", mean);
    std::printf("\n");
  }
}

// module/src/diffusion_error_table.h.
void printTable(Bench& bench, const std::vector<double>& radii) {
  std::vector<std::vector<double>> columns;
  for (const double radius : radii) columns.push_back(bench.worst(radius, kQualities));
  std::printf(
      "// Relative RMSE of the diffusion from brute force, of qualities 0 and 1, which 2 shares, at each "
      "radius "
      "(pixels\n"
      "// within which 99.9 %% of the energy lies) the worst of the scenes of docs/diffusion.md. Written by\n"
      "// build/bin/pellucid_diffusion_error --table, which --check measures again.\n"
      "#pragma once\n\nnamespace pellucid {\n\nconstexpr float kErrorRadii[] = {");
  for (size_t i = 0; i < radii.size(); ++i) std::printf("%s%g", i ? ", " : "", radii[i]);
  std::printf("};\nconstexpr float kWorstError[][%zu] = {", radii.size());
  for (const uint32_t quality : kQualities) {
    std::printf("\n    {");
    for (size_t i = 0; i < radii.size(); ++i) std::printf("%s%.4ff", i ? ", " : "", columns[i][quality]);
    std::printf("},");
  }
  std::printf("\n};\n\n}  // namespace pellucid\n");
}

// Whether errors at these radii, of all qualities, are at most a tenth above the module's table.
bool holdsTable(Bench& bench, const std::vector<double>& radii) {
  bool holds = true;
  for (const double radius : radii) {
    const auto* column =
        std::find(std::begin(pellucid::kErrorRadii), std::end(pellucid::kErrorRadii), radius);
    if (column == std::end(pellucid::kErrorRadii))
      throw InputError("", "--radius", std::to_string(radius) + " is not in the module's table");
    const std::vector<double> measured = bench.worst(radius, kQualities);
    for (const uint32_t quality : kQualities) {
      const auto stated = static_cast<double>(pellucid::kWorstError[quality][column - pellucid::kErrorRadii]);
      const bool within = measured[quality] <= 1.1 * stated;
      std::printf("quality %u, %g px: %.4f, stated %.4f%s\n", quality, radius, measured[quality], stated,
                  within ? "" : " EXCEEDED");
      holds = holds && within;
    }
  }
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  std::string device;
  int size = 96, pixels = std::numeric_limits<int>::max();
  uint32_t quality = 1;
  bool table = false, check = false, means = false;
  std::vector<double> radii(std::begin(pellucid::kErrorRadii), std::end(pellucid::kErrorRadii));
  CLI::App app("Relative RMSE of the module's diffusion from brute force, worst channel.",
               "pellucid_diffusion_error");
  app.add_option("--device", device, "part of the Vulkan device's name");
  app.add_option("--size", size, "pixels a side")->check(CLI::Range(16, 512))->capture_default_str();
  app.add_option("--error-pixels", pixels,
                 "of a scene, at most, where brute force says the error; default all")
      ->check(CLI::Range(16, 1000000));
  app.add_option("--quality", quality, "PellucidFrame::quality")
      ->check(CLI::Range(0, 3))
      ->capture_default_str();
  app.add_flag("--table", table, "print module/src/diffusion_error_table.h instead");
  app.add_flag("--check", check, "compare with it instead; 1 if an error is exceeded by a tenth");
  app.add_flag("--mean", means, "print the root mean squares over the scenes instead, of qualities 0 and 1");
  app.add_option("--radius", radii, "pixels within which 99.9 % of the energy lies; several with commas")
      ->delimiter(',')
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    Bench bench(device, size, pixels);
    if (means)
      printMeans(bench, radii);
    else if (table)
      printTable(bench, radii);
    else if (check)
      return holdsTable(bench, radii) ? 0 : 1;
    else
      printScenes(bench, radii, quality);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_diffusion_error: %s\n", e.what());
    return dynamic_cast<const DeviceError*>(&e) ? 4 : 3;
  }
}
