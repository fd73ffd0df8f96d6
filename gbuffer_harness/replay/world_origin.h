// A world whose floats are fine enough where the camera is.
#pragma once

#include <array>

#include "capture/capture.h"

namespace pellucid::harness {

// Near the camera, where it stands so far from the world's origin that floats would move shadow maps against
// what it sees; else 0, 0, 0.
std::array<double, 3> worldOrigin(const Capture& capture);

}  // namespace pellucid::harness
