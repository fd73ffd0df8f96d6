#include "gather_error.h"

#include <algorithm>

#include "bench_frame.h"
#include "common/compare.h"
#include "reference/reference.h"
#include "scene.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

std::vector<double> gatherErrors(const Site& site, const std::vector<uint32_t>& samples) {
  SceneParameters p;
  p.name = "ear";
  p.width = p.height = 128;
  p.shadowSize = 384;
  Capture capture = makeScene(p);
  capture.albedo = {};
  capture.lights.resize(1);
  // The scene measures transmitted light alone. Lit surfaces also return gathered light, so their pixels do not count.
  const std::vector<std::uint8_t> unlit = comparisonMask(capture.material, capture.irradiance, Subset::Unlit);
  std::fill(capture.irradiance.data.begin(), capture.irradiance.data.end(), 0.0f);
  ReplaySettings settings;
  settings.translucency.gatherSamples = samples.front();
  reference::Settings all;
  all.features = settings.features;
  all.translucency = settings.translucency;
  constexpr int kBox = 4;
  all.wanted = spreadPixels(capture, site.errorPixels, kBox);
  for (size_t i = 0; i < unlit.size(); ++i) all.wanted[i] &= unlit[i];
  const std::vector<PellucidMaterial> materials(capture.materials.size(), site.material);
  const Image truth = reference::compute(capture, materials, all).image;
  std::vector<double> errors;
  for (const uint32_t n : samples) {
    settings.translucency.gatherSamples = n;
    const Image image = site.run(moduleVariant(site.frame(capture, settings), ""));
    double worst = 0;
    for (const ChannelDifference& channel : compareImages(image, truth, all.wanted, kBox).channels)
      worst = std::max(worst, channel.relativeRmse);
    errors.push_back(worst);
  }
  return errors;
}

}  // namespace pellucid::bench
