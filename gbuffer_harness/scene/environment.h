// Light from all around.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace pellucid::harness {

// Real spherical harmonics of a unit direction, in the order of PellucidFrameOptions::ambient.
inline std::array<double, 9> harmonicBasis(const std::array<double, 3>& direction) {
  const auto [x, y, z] = direction;
  const double inversePi = std::numbers::inv_pi;
  const double y0 = std::sqrt(inversePi) / 2, y1 = std::sqrt(0.75 * inversePi), y2 = std::sqrt(3.75 * inversePi);
  return {y0,         y1 * y,
          y1 * z,     y1 * x,
          y2 * x * y, y2 * y * z,
          y2 / std::sqrt(12) * (3 * z * z - 1), y2 * x * z,
          y2 / 2 * (x * x - y * y)};
}

// Radiance (R, G, B, linear) that is linear in y of the direction it comes from: `up` from +y, `down` from
// -y.
struct Environment {
  std::array<double, 3> up = {1, 1, 1}, down = {1, 1, 1};

  // y: of a unit direction, -1 .. 1.
  std::array<double, 3> radiance(double y) const {
    std::array<double, 3> result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = down[c] + (up[c] - down[c]) * (0.5 + 0.5 * y);
    return result;
  }

  // In the order of PellucidFrameOptions::ambient; of a linear function the first two of nine say all.
  std::array<std::array<double, 3>, 9> harmonics() const {
    std::array<std::array<double, 3>, 9> result{};
    for (std::size_t c = 0; c < 3; ++c) {
      result[0][c] = (up[c] + down[c]) * std::sqrt(std::numbers::pi);
      result[1][c] = (up[c] - down[c]) * std::sqrt(std::numbers::pi / 3);
    }
    return result;
  }
};

}  // namespace pellucid::harness
