#include "metrics/eye.h"

#include "common/compare.h"
#include "common/error.h"

namespace pellucid::harness {

EyeMetrics measureEye(const Image& result, const Capture& capture, double exposure) {
  if (!capture.truth) throw InputError(capture.name, "truth", "missing: there is nothing to compare with");
  const Image& truth = capture.truth->image;
  const Surfaces surfaces(capture);
  const Mask mask = comparisonMask(capture.material, capture.irradiance, Subset::All);
  EyeMetrics metrics;
  metrics.isolated = findIsolated(result, surfaces, mask).count;
  metrics.isolatedInTruth = findIsolated(truth, surfaces, mask).count;
  const SpotImage input(litAlbedo(capture), surfaces, mask), seen(result, surfaces, mask);
  metrics.spots = seen.lackedBy(SpotImage(truth, surfaces, mask), seen.find(&input)).size();
  metrics.tint = measureTint(result, truth, mask);
  metrics.flip = measureFlip(result, truth, mask, exposure);
  return metrics;
}

}  // namespace pellucid::harness
