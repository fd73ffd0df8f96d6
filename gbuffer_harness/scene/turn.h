// Turntables: a camera and lights turned about a vertical line. The geometry stays where it is, so that
// every frame sees exactly the same surfaces; a model that turns by an angle before a fixed camera is a
// camera and lights that turn by the opposite one.
#pragma once

#include <optional>

#include "capture/capture.h"
#include "scene/camera.h"

namespace pellucid::harness {

// Radians about +y, counterclockwise as seen from above. Absent: not turned, not even by 0.
struct Turn {
  std::optional<double> camera, lights;
};

// viewFromWorld of the camera carried round the vertical line through `center` by `angle`. Angle 0 gives
// the same bits.
Matrix turnedView(const Matrix& viewFromWorld, const Vector3& center, double angle);

// The light's position and direction carried round the same way; without its shadow map.
// Angle 0 gives the same bits.
Light turnedLight(const Light& light, const Vector3& center, double angle);

}  // namespace pellucid::harness
