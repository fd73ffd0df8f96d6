// How brightly halves hold a capture's light.
#pragma once

#include "capture/capture.h"

namespace pellucid::harness {

// The largest irradiance of the frame: that of its pixels with a material, and what each light and the
// environment could bring to a face that looks at them, at the distance of the nearest of these pixels. Of a
// capture without images that of its directional lights and environment. 0: there is none.
double largestLight(const Capture& capture);

// A power of 2 as PellucidFrame::preExposure: 1 where halves hold the capture's light as it is, else what
// brings the largest light to 1 .. 2. Physical units, such as a sun of 1e5 lux, need one below 1.
float preExposureFor(const Capture& capture);

}  // namespace pellucid::harness
