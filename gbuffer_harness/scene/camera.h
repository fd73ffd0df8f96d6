// Cameras in double precision.
#pragma once

#include <array>

#include "capture/capture.h"

namespace pellucid::harness {

using Vector3 = std::array<double, 3>;

// Planar distances of the clip planes along the view axis, scene units, 0 < nearPlane < farPlane
// (orthographic: nearPlane may be <= 0). farPlane may be infinity for a perspective.
struct ClipRange {
  double nearPlane = 1, farPlane = 1000;
  bool reversed = false;  // device depth 1 at nearPlane, 0 at farPlane
};

// clipFromView of a symmetric frustum, Vulkan clip space: y down, depth 0..1, w > 0 in front.
// verticalFov: radians, (0, pi). aspect: width / height. Throws InputError on values outside.
Matrix perspective(double verticalFov, double aspect, const ClipRange& range);

// clipFromView of a box `width` by `height` scene units around the axis. Throws InputError.
Matrix orthographic(double width, double height, const ClipRange& range);

// Rigid viewFromWorld of an eye looking at target, along -z. `up` need not be perpendicular; when it is
// parallel to the axis another one is taken.
Matrix lookAt(const Vector3& eye, const Vector3& target, const Vector3& up);

// Device depth of a planar distance through clipFromView; not clamped.
double deviceDepth(const Matrix& clipFromView, double viewZ);

// Device depth of "nothing there": that of the end of the range where distances grow.
double clearDepth(const Matrix& clipFromView);

// a * b.
Matrix multiply(const Matrix& a, const Matrix& b);

}  // namespace pellucid::harness
