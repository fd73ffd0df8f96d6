// Costs of float arithmetic and 16-bit storage: errors of the shaders on small images, against float64.
#pragma once

#include <string>
#include <vector>

#include "replay/replay.h"

namespace pellucid::test {

// A depth buffer's format, its projection, and how far thicknesses measured from it are off. Surfaces are 0.3
// to 5 m away and 0.5 to 30 mm thick.
struct DepthErrors {
  std::string format;
  double nearPlane, farPlane;  // m; infinite: no far plane
  // Worst relative errors of the thickness.
  double
      stored;  // of the depths as the format stores them, in float64, from the truth: no arithmetic mends it
  double shader;  // of the GPU's thickness from that of the stored depths in float64
  double naive;   // likewise of the float32 difference of two linearized depths
  int pixels;     // whose stored depths differ
};

std::vector<DepthErrors> measureDepths(harness::Replayer& replayer);

// The frame with 16-bit colors, output and intermediates, against the same with 32-bit ones.
struct HalfErrors {
  double irradiance;   // of about 1 in the middle
  uint32_t samples;    // of the gather
  double worst, rmse;  // relative to the 32-bit result of the pixel and channel
};

std::vector<HalfErrors> measureHalves(harness::Replayer& replayer);

}  // namespace pellucid::test
