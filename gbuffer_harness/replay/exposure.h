// How halves hold the light of a capture, and floats its world.
#pragma once

#include <array>

#include "capture/capture.h"

namespace pellucid::harness {

// The largest irradiance of the frame: that of its pixels with a material, and what each light and the
// environment could bring to a face that looks at them, at the distance of the nearest of these pixels. Of a
// capture without images that of its directional lights and environment. 0: there is none.
double largestLight(const Capture& capture);

// A power of 2 as PellucidFrame::preExposure: 1 where halves hold the capture's light as it is, else what
// brings the largest light to 1 .. 2. Physical units, such as a sun of 1e5 lux, need one below 1.
float preExposureFor(const Capture& capture);

// Near the camera, where it stands so far from the world's origin that floats would move shadow maps against
// what it sees; else 0, 0, 0.
std::array<double, 3> worldOrigin(const Capture& capture);

}  // namespace pellucid::harness
