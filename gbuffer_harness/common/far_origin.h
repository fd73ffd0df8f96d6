// Origins of worlds in which floats are fine enough around a place that is seen.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pellucid::harness {

// Largest distance from the origin, as a multiple of the seen distance. Floats there still tell apart 1/65536
// of the seen distance.
inline constexpr double kFarthest = 256;
// The seen distance is not much more than so many near planes.
inline constexpr double kNearPlanes = 100;

// The place in whole units of the seen distance, so that frames of a sequence share an origin while the place
// moves a little.
inline std::array<double, 3> originNear(std::array<double, 3> place, double seenDistance) {
  const double unit = std::exp2(std::ceil(std::log2(std::max(seenDistance, 1e-30))));
  for (double& x : place) x = std::round(x / unit) * unit;
  return place;
}

// The matrix, column-major, from a world that begins at `origin`.
inline std::array<double, 16> fromOrigin(const std::array<double, 16>& fromWorld,
                                         const std::array<double, 3>& origin) {
  std::array<double, 16> result = fromWorld;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t i = 0; i < 3; ++i) result[12 + row] += fromWorld[4 * i + row] * origin[i];
  return result;
}

}  // namespace pellucid::harness
