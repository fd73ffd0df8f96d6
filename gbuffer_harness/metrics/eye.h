// All metrics of one result against the truth of its capture.
#pragma once

#include "capture/capture.h"
#include "metrics/flip.h"
#include "metrics/isolated.h"
#include "metrics/tint.h"

namespace pellucid::harness {

struct EyeMetrics {
  std::size_t isolated = 0, isolatedInTruth = 0;  // pixels, of all that have a material
  Tint tint, tintLit;  // of all blocks, and of those all of whose pixels are lit from the front
  Flip flip;           // over the pixels with a material
};

// `result`: three channels. exposure: as measureFlip(). Throws InputError without a truth, or when the sizes
// differ.
EyeMetrics measureEye(const Image& result, const Capture& capture, double exposure = 0);

}  // namespace pellucid::harness
