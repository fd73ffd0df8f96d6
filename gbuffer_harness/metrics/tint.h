// How much brightness and color of a result wander about the truth's.
#pragma once

#include <array>
#include <cstddef>

#include "metrics/masked_image.h"
#include "metrics/surface.h"

namespace pellucid::harness {

inline constexpr int kTintBlock = 8;  // pixels a side

struct Tint {
  // Standard deviations over blocks, 0 for equal images and for a result that is the truth times a constant.
  std::array<double, 3> channel = {};  // of the ratio a / b
  double redOverGreen = 0;             // of the ratio of red to that of green
  std::size_t blocks = 0;              // that were judged; 0: the deviations are 0
};

// Ratios of means over 8x8 blocks, counted from pixel (0, 0), that are wholly of surface, all of whose pixels
// count, and whose mean of b is above kDarkestPart of the RMS of b over the mask in every channel. Throws
// InputError when an image has not three channels and the surfaces' size.
Tint measureTint(const Image& a, const Image& b, const Surfaces& surfaces, const Mask& mask);

}  // namespace pellucid::harness
