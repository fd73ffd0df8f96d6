// Bytes of sRGB images as linear values; IEC 61966-2-1.
#pragma once

#include <cmath>
#include <cstdint>

namespace pellucid::harness {

// 0 .. 255 as 0 .. 1.
inline double linearOf(std::uint8_t srgb) {
  const double v = srgb / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace pellucid::harness
