// Light from all around.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace pellucid::harness {

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
