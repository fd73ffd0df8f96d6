#include "metrics/eye.h"

#include "common/compare.h"
#include "common/error.h"

namespace pellucid::harness {

EyeMetrics measureEye(const Image& result, const Capture& capture, double exposure) {
  if (!capture.truth) throw InputError(capture.name, "truth", "missing: there is nothing to compare with");
  const Image& truth = capture.truth->image;
  const Surfaces surfaces(capture);
  const Mask all = comparisonMask(capture.material, capture.irradiance, Subset::All);
  const Mask lit = comparisonMask(capture.material, capture.irradiance, Subset::Lit);
  EyeMetrics metrics;
  metrics.isolated = findIsolated(result, surfaces, all).count;
  metrics.isolatedInTruth = findIsolated(truth, surfaces, all).count;
  metrics.tint = measureTint(result, truth, surfaces, all);
  metrics.tintLit = measureTint(result, truth, surfaces, lit);
  metrics.flip = measureFlip(result, truth, all, exposure);
  return metrics;
}

}  // namespace pellucid::harness
