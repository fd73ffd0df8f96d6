// Bytes of sRGB images as linear values; IEC 61966-2-1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pellucid::harness {

// 0 .. 255 as 0 .. 1.
inline double linearOf(std::uint8_t srgb) {
  const double v = srgb / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// The inverse; values outside of 0 .. 1 count as 0 or 1.
inline std::uint8_t srgbOf(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double v = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * v));
}

}  // namespace pellucid::harness
