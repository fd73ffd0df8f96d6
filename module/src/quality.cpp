#include "quality.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diffusion_error_table.h"
#include "frame.h"
#include "frame_error_table.h"
#include "pyramid_energy.h"
#include "shared/pellucid_filters.h"

namespace pellucid {
namespace {

// Pixels per mm on a facing surface at the nearest distance, along the finer side; 0: not known. All that is
// farther or tilted has fewer.
double pixelsPerMm(const FrameFacts& facts) {
  const PellucidFrame& f = facts.frame;
  const glm::dmat4& clip = facts.clipFromView;
  const DepthRange& range = facts.depthRange;
  if (range.perspective && f.nearestDistance == 0) return 0;
  // clip.xy / w spans 2 over the image; see makeCamera.
  const double w = range.c * static_cast<double>(f.nearestDistance) + range.d;
  const glm::dmat2 inverse = glm::inverse(glm::dmat2(clip[0][0], clip[0][1], clip[1][0], clip[1][1]));
  const double side = std::min(glm::length(inverse[0]) * 2 / f.imageExtent[0],
                               glm::length(inverse[1]) * 2 / f.imageExtent[1]);
  const double mm = side * std::abs(w) * static_cast<double>(f.metersPerUnit) * 1000;
  return mm > 0 ? 1 / mm : 0;
}

// The worst at radii up to `radius` pixels; 0: at all.
float diffusionError(double radius) {
  // Errors were measured at some radii; up to the first one that is not less than the frame's.
  size_t count = std::size(kErrorRadii);
  if (radius > 0) {
    const float* least = std::lower_bound(std::begin(kErrorRadii), std::end(kErrorRadii), radius);
    count = std::min(count, static_cast<size_t>(least - kErrorRadii) + 1);
  }
  return *std::max_element(kWorstError, kWorstError + count);
}

// Only maps let light be gathered. Lights have not been checked yet.
bool someLightHasMap(const PellucidFrame& f) {
  return f.lights && std::any_of(f.lights, f.lights + f.lightCount,
                                 [](const PellucidLight& light) { return light.shadowMapCount > 0; });
}

// The frame's error with the samples of kTargetSamples[choice].
float measuredError(const FrameFacts& f, size_t choice) {
  if ((f.frame.features & PELLUCID_FEATURE_TRANSLUCENCY) == 0 || f.frame.lightCount == 0)
    return diffusionError(f.reach.radius);
  return kFrameError[f.whyNotGathered || !someLightHasMap(f.frame) ? 0 : choice];
}

}  // namespace

double widestDeviation(const PellucidMaterial& m) {
  double variance = 0;
  for (int c = 0; c < 3; ++c)
    for (uint32_t i = 0; i < m.gaussianCount; ++i)
      if (m.gaussianWeight[c][i] > 0)
        variance = std::max(variance, static_cast<double>(m.gaussianVariance[c][i]));
  return std::sqrt(variance);
}

double levelDeviation(uint32_t level) {
  return std::sqrt(PELLUCID_LEVEL_VARIANCE_SCALE * std::exp2(2.0 * level) + PELLUCID_LEVEL_VARIANCE_REST);
}

double deviationWithin(uint32_t level) { return std::exp2(level + 1 + kCoarserBegins); }

DiffusionReach diffusionReach(const FrameFacts& facts) {
  // No infinity may reach the plan's text.
  DiffusionReach reach{std::min(pixelsPerMm(facts), 1e30), 0, 0};
  const auto pixels = [&](double mm) { return std::min(mm * reach.pixelsPerMm, 1e30); };
  for (uint32_t i = 0; i < facts.frame.materialCount; ++i) {
    const PellucidMaterial m = facts.diffused(i);
    if (m.gaussianCount == 0) continue;
    const double radius = static_cast<double>(*std::max_element(m.radius, m.radius + 3));
    reach.radius = std::max(reach.radius, pixels(radius));
    reach.deviation = std::max(reach.deviation, pixels(widestDeviation(m)));
  }
  return reach;
}

bool samplesOfTarget(const FrameFacts& facts, uint32_t* samples) {
  for (size_t i = 0; i < std::size(kTargetSamples); ++i) {
    *samples = kTargetSamples[i];
    if (measuredError(facts, i) < facts.frame.targetError) return true;
  }
  return false;
}

}  // namespace pellucid
