// What the benchmarks run on.
#pragma once

#include "capture/capture.h"
#include "pellucid/pellucid.h"

namespace pellucid::bench {

// skin1 of Jensen et al. 2001.
PellucidMaterial benchMaterial();

// The capture without exit depths and caster materials: few engines have them, and the other methods here
// bind no images for them.
harness::Capture withMapsAlone(harness::Capture capture);

// A 2 mm slab with pixels of 0.1 mm, noise in the irradiance and of a hundredth of a pixel in the depths, one
// directional light from behind with a shadow map of about a texel a pixel, at most 1024^2.
harness::Capture slab(int width, int height);

// Of the slab's first pixel, mm.
double slabThickness(const harness::Capture& slab);

}  // namespace pellucid::bench
