// pellucid_diffusion_error: the module's diffusion against the float64 reference, every pixel against every
// other, over radii and scenes, as the table of docs/diffusion.md.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "common/compare.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"
#include "reference/reference.h"
#include "replay/replay.h"
#include "scene.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;

// The largest channel's.
double relativeRmse(const Image& image, const Image& truth, const Capture& capture) {
  const Comparison c =
      compareImages(image, truth, comparisonMask(capture.material, capture.irradiance, Subset::All));
  double worst = 0;
  for (const ChannelDifference& k : c.channels) worst = std::max(worst, k.relativeRmse);
  return worst;
}

void table(const std::string& deviceName, int size, const std::vector<double>& radii) {
  Device device({deviceName, false});
  const Context context(device);
  std::printf("| scene, %d x %d pixels |", size, size);
  for (const double radius : radii) std::printf(" %g px |", radius);
  std::printf("\n|-|");
  for (size_t i = 0; i < radii.size(); ++i) std::printf("-|");
  std::printf("\n");
  for (const ErrorScene& scene : errorScenes()) {
    std::printf("| %s |", scene.title.c_str());
    for (const double radius : radii) {
      const Capture capture = makeErrorCapture(scene, size);
      const PellucidMaterial material = burleyMaterial(radius * scene.width / size);
      ReplaySettings replaySettings;
      replaySettings.features = PELLUCID_FEATURE_DIFFUSION;
      reference::Settings settings;
      settings.features = PELLUCID_FEATURE_DIFFUSION;
      const Image truth = reference::compute(capture, {material}, settings).image;
      FrameRun run(device, context, capture, {material}, replaySettings);
      device.run([&](VkCommandBuffer c) { run.record(c); });
      std::printf(" %.4f |", relativeRmse(rgb(run.output()), truth, capture));
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string device;
  int size = 96;
  std::vector<double> radii = {0.5, 2, 8, 32, 128};
  CLI::App app("Relative RMSE of the module's diffusion from brute force, worst channel.", "pellucid_diffusion_error");
  app.add_option("--device", device, "part of the Vulkan device's name");
  app.add_option("--size", size, "pixels a side")->check(CLI::Range(16, 512))->capture_default_str();
  app.add_option("--radius", radii, "pixels within which 99.9 % of the energy lies; several with commas")
      ->delimiter(',')
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    table(device, size, radii);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_diffusion_error: %s\n", e.what());
    return dynamic_cast<const DeviceError*>(&e) ? 4 : 3;
  }
}
