// A picture of where a result is brighter, darker or of another color than the truth.
#pragma once

#include <cstdint>
#include <vector>

#include "metrics/masked_image.h"

namespace pellucid::harness {

inline constexpr int kRatioBlock = 4;           // pixels a side
inline constexpr double kRatioFullColor = 0.1;  // deviation at which a channel reaches black or 255

// 3 bytes a pixel, row 0 first. Each block of 4x4 pixels, counted from (0, 0), shows e = (A - B) /
// max(B, kDarkestPart * RMS(B)) of the means over its pixels that count: 127.5 + 127.5 e / kRatioFullColor in
// each channel, clamped. So gray is right, white 10 % too bright, red 10 % too red, cyan 10 % too little red.
// Pixels that do not count are black. Throws InputError when the images are not of one size with three
// channels.
std::vector<std::uint8_t> ratioMap(const Image& a, const Image& b, const Mask& mask);

}  // namespace pellucid::harness
