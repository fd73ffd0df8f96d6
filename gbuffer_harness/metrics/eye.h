// The metrics of one result against the truth of its capture, over the pixels that have a material.
#pragma once

#include "capture/capture.h"
#include "metrics/flip.h"
#include "metrics/isolated.h"
#include "metrics/spots.h"
#include "metrics/tint.h"

namespace pellucid::harness {

struct EyeMetrics {
  std::size_t isolated = 0, isolatedInTruth = 0;  // pixels
  std::size_t spots = 0;                          // that irradiance and truth lack
  Tint tint;
  Flip flip;
};

// `result`: three channels. exposure: as measureFlip(). Throws InputError without a truth, or when the sizes
// differ.
EyeMetrics measureEye(const Image& result, const Capture& capture, double exposure = 0);

}  // namespace pellucid::harness
