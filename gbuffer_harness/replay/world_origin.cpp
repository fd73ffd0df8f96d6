#include "replay/world_origin.h"

#include <algorithm>
#include <cmath>

#include "common/far_origin.h"

namespace pellucid::harness {

namespace {

// The distance that is seen, in scene units; 0: the matrix does not say.
double seenDistance(const Matrix& clip) {
  if (clip[15] != 0) return 2 / std::abs(clip[5]);
  // Depths 0 and 1, of which one is the near plane.
  const double depths[] = {clip[14] / clip[10], (clip[14] - clip[15]) / (clip[10] - clip[11])};
  double nearest = INFINITY;
  for (const double depth : depths)
    if (depth > 0) nearest = std::min(nearest, depth);
  return std::isfinite(nearest) ? kNearPlanes * nearest : 0;
}

}  // namespace

std::array<double, 3> worldOrigin(const Capture& capture) {
  const Matrix& view = capture.viewFromWorld;
  std::array<double, 3> eye{};  // the rotation's transpose is its inverse
  double length = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) eye[i] -= view[4 * i + k] * view[12 + k];
    length = std::max(length, std::abs(eye[i]));
  }
  const double seen = seenDistance(capture.clipFromView);
  if (!(seen > 0) || !std::isfinite(length) || !(length > kFarthest * seen)) return {0, 0, 0};
  return originNear(eye, seen);
}

}  // namespace pellucid::harness
