// pellucid_diffusion_error: the module's diffusion against the float64 reference, every pixel against every
// other, over radii and scenes: the tables of docs/accuracy.md and of bench/diffusion_error_table.h.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "common/compare.h"
#include "common/error.h"
#include "diffusion_error_table.h"
#include "pellucid/pellucid_material.h"
#include "reference/reference.h"
#include "replay/replay.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::harness;

// A scene that the diffusion's errors are stated for.
struct ErrorScene {
  std::string title, scene;
  std::map<std::string, double> options;
  double width;  // visible, scene units
  // If > 0, the irradiance is a checker of that side in the image, scene units, at 17 degrees.
  double checker = 0;
};

std::vector<ErrorScene> errorScenes() {
  const double plane = 40;
  const std::map<std::string, double> tilted = {{"tilt", 60}};
  return {
      {"checker of 1/8 of the width, at 17 degrees", "checker", {{"cell", plane / 8}, {"angle", 17}}, plane},
      {"step at 30 degrees", "step", {{"angle", 30}}, plane},
      {"tilted by 60 degrees, step", "step", tilted, plane},
      {"tilted by 60 degrees, step at 30 degrees", "step", {{"tilt", 60}, {"angle", 30}}, plane},
      {"tilted by 60 degrees, checker at 17 degrees",
       "checker",
       {{"cell", plane / 8}, {"angle", 17}, {"tilt", 60}},
       plane},
      {"sphere, lit from the side", "sphere", {{"lightAngle", 110}}, plane},
      {"sphere, checker at 17 degrees", "sphere", {}, plane, plane / 8},
      {"ear", "ear", {}, 92}};
}

// The irradiance of each pixel with a material is the mean of a checker over 4 x 4 points of the pixel.
void paintChecker(Capture& capture, double side) {
  constexpr double kAngle = 17 * std::numbers::pi / 180;
  constexpr int kPoints = 4;
  const double c = std::cos(kAngle) / side, s = std::sin(kAngle) / side;
  for (int y = 0; y < capture.height; ++y)
    for (int x = 0; x < capture.width; ++x) {
      int lit = 0;
      for (int i = 0; i < kPoints * kPoints; ++i) {
        const double u = x + (i % kPoints + 0.5) / kPoints, v = y + (i / kPoints + 0.5) / kPoints;
        lit += static_cast<int>(std::floor(c * u + s * v) + std::floor(c * v - s * u)) % 2 == 0 ? 1 : 0;
      }
      const bool covered = capture.material[reference::pixelNumber(capture.irradiance, x, y)] != 0;
      for (int k = 0; k < 3; ++k)
        capture.irradiance.at(x, y)[k] = covered ? static_cast<float>(lit) / (kPoints * kPoints) : 0;
    }
}

// `size` pixels a side; all lengths scaled so that a pixel is 1 mm wide where the scene has its width.
Capture makeErrorCapture(const ErrorScene& scene, int size) {
  SceneParameters p{.name = scene.scene, .width = size, .height = size, .options = scene.options};
  if (scene.scene == "checker" || scene.scene == "step") p.options["samples"] = 4;
  p.shadowSize = 0;
  Capture capture = makeScene(p);
  capture.metersPerUnit = 0.001 * size / scene.width;
  if (scene.checker > 0) paintChecker(capture, scene.checker * size / scene.width);
  capture.albedo = {};  // the error is the diffusion's
  return capture;
}

// One value per pixel: 1 at about `count` of the pixels with a material, spread at random with a fixed seed;
// at all where there are no more.
std::vector<std::uint8_t> spreadPixels(const Capture& capture, int count) {
  const auto covered =
      std::count_if(capture.material.begin(), capture.material.end(), [](auto m) { return m != 0; });
  std::mt19937 random(5);
  std::vector<std::uint8_t> wanted;
  for (const std::uint8_t material : capture.material) {
    const bool chosen = random() % static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(covered, 1)) <
                        static_cast<std::uint64_t>(count);
    wanted.push_back(chosen && material != 0);
  }
  return wanted;
}

// Burley's profile (Christensen & Burley 2015) with 99.9 % of the energy within `radius` mm in red, and
// distances 1/1.4 and 1/2 of that in green and blue.
PellucidMaterial burleyMaterial(double radius) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  desc.kind = PELLUCID_MATERIAL_BURLEY;
  // 3/4 e^{-r / 3d} = .001 - 1/4 e^{-r / d} holds at r = 19.86 d (Christensen & Burley 2015, the cdf).
  const double d = radius / 19.86;
  desc.burleyDistance[0] = d;
  desc.burleyDistance[1] = d / 1.4;
  desc.burleyDistance[2] = d / 2;
  PellucidMaterial material;
  if (pellucidCompileMaterial(&desc, &material, nullptr, nullptr, nullptr) != PELLUCID_OK)
    throw InputError("", "burleyDistance", "does not compile");
  return material;
}

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

  // At a radius in pixels.
  double error(const ErrorScene& scene, double radius) {
    const Capture capture = makeErrorCapture(scene, size);
    const PellucidMaterial material = burleyMaterial(radius);
    reference::Settings settings;
    settings.features = PELLUCID_FEATURE_DIFFUSION;
    settings.wanted = spreadPixels(capture, pixels);
    const Image truth = reference::compute(capture, {material}, settings).image;
    ReplaySettings replaySettings;
    replaySettings.features = PELLUCID_FEATURE_DIFFUSION;
    FrameRun run(device, context, capture, {material}, replaySettings);
    device.run([&](VkCommandBuffer c) { run.record(c); });
    return relativeRmse(rgb(run.output()), truth, settings.wanted);
  }

  // Of the worst scene.
  double worst(double radius) {
    double most = 0;
    for (const ErrorScene& scene : errorScenes()) most = std::max(most, error(scene, radius));
    return most;
  }
};

// The error of each scene, and the root mean square of these errors.
void printScenes(Bench& bench, const std::vector<double>& radii) {
  std::printf("| scene, %d x %d pixels |", bench.size, bench.size);
  for (const double radius : radii) std::printf(" %g px |", radius);
  std::printf("\n|-|");
  for (size_t i = 0; i < radii.size(); ++i) std::printf("-|");
  std::printf("\n");
  std::vector<double> squares(radii.size(), 0);
  for (const ErrorScene& scene : errorScenes()) {
    std::printf("| %s |", scene.title.c_str());
    for (size_t i = 0; i < radii.size(); ++i) {
      const double error = bench.error(scene, radii[i]);
      squares[i] += error * error;
      std::printf(" %.4f |", error);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  std::printf("| root mean square |");
  for (const double sum : squares)
    std::printf(" %.5f |", std::sqrt(sum / static_cast<double>(errorScenes().size())));
  std::printf("\n");
}

// bench/diffusion_error_table.h.
void printTable(Bench& bench, const std::vector<double>& radii) {
  std::vector<double> errors;
  for (const double radius : radii) errors.push_back(bench.worst(radius));
  std::printf(
      "// Relative RMSE of the diffusion from brute force at each radius (pixels within which 99.9 %% of the "
      "energy lies), the worst of\n"
      "// the scenes of docs/accuracy.md. Written by build/bin/pellucid_diffusion_error --table, which "
      "--check "
      "measures again.\n"
      "#pragma once\n\nnamespace pellucid {\n\nconstexpr float kErrorRadii[] = {");
  for (size_t i = 0; i < radii.size(); ++i) std::printf("%s%g", i ? ", " : "", radii[i]);
  std::printf("};\nconstexpr float kWorstError[] = {");
  for (size_t i = 0; i < errors.size(); ++i) std::printf("%s%.4ff", i ? ", " : "", errors[i]);
  std::printf("};\n\n}  // namespace pellucid\n");
}

// True if the errors at these radii are at most a tenth above the module's table.
bool holdsTable(Bench& bench, const std::vector<double>& radii) {
  bool holds = true;
  for (const double radius : radii) {
    const auto* column =
        std::find(std::begin(pellucid::kErrorRadii), std::end(pellucid::kErrorRadii), radius);
    if (column == std::end(pellucid::kErrorRadii))
      throw InputError("", "--radius", std::to_string(radius) + " is not in the module's table");
    const double measured = bench.worst(radius);
    const auto stated = static_cast<double>(pellucid::kWorstError[column - pellucid::kErrorRadii]);
    const bool within = measured <= 1.1 * stated;
    std::printf("%g px: %.4f, stated %.4f%s\n", radius, measured, stated, within ? "" : " EXCEEDED");
    holds = holds && within;
  }
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  std::string device;
  int size = 96, pixels = std::numeric_limits<int>::max();
  bool table = false, check = false;
  std::vector<double> radii(std::begin(pellucid::kErrorRadii), std::end(pellucid::kErrorRadii));
  CLI::App app("Relative RMSE of the module's diffusion from brute force, worst channel.",
               "pellucid_diffusion_error");
  app.add_option("--device", device, "part of the Vulkan device's name");
  app.add_option("--size", size, "pixels a side")->check(CLI::Range(16, 512))->capture_default_str();
  app.add_option("--error-pixels", pixels,
                 "of a scene, at most, where brute force says the error; default all")
      ->check(CLI::Range(16, 1000000));
  app.add_flag("--table", table, "print bench/diffusion_error_table.h instead");
  app.add_flag("--check", check, "compare with it instead; 1 if an error is exceeded by a tenth");
  app.add_option("--radius", radii, "pixels within which 99.9 % of the energy lies; several with commas")
      ->delimiter(',')
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    Bench bench(device, size, pixels);
    if (table)
      printTable(bench, radii);
    else if (check)
      return holdsTable(bench, radii) ? 0 : 1;
    else
      printScenes(bench, radii);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_diffusion_error: %s\n", e.what());
    return dynamic_cast<const DeviceError*>(&e) ? 4 : 3;
  }
}
