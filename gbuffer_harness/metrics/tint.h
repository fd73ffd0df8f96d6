// How much brightness and color of a result wander about the truth's.
#pragma once

#include <array>
#include <cstddef>

#include "metrics/masked_image.h"

namespace pellucid::harness {

inline constexpr int kTintBlock = 8;  // pixels a side
inline constexpr double kTintDarkestPart = 0.1;

struct Tint {
  // Standard deviations over blocks: 0 for a result that is the truth times a color; NaN without blocks.
  std::array<double, 3> channel = {};  // of the ratio a / b
  double redOverGreen = 0;             // of the ratio of red to that of green
  std::size_t blocks = 0;              // that were judged
};

// Ratios of means over 8x8 blocks, counted from pixel (0, 0), all of whose pixels count and whose mean of b
// is above kTintDarkestPart of the RMS of b over the mask in every channel: truth is noisy where it is dark.
// With a mask of material these are the lit blocks wholly of surface. Throws InputError when the images are
// not of one size with three channels.
Tint measureTint(const Image& a, const Image& b, const Mask& mask);

}  // namespace pellucid::harness
