#include "reference/drawn_depth.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pellucid::harness::reference {

DrawnDepth drawnDepth(const ShadowMap& map, int x, int y, const std::function<bool(float)>& holds) {
  const Image& image = map.depth.image;
  const double stored = double(*image.at(x, y));
  // Vulkan 1.3, "Depth Bias": the larger of the changes along x and y. Along each axis the nearer neighbor is
  // more likely of the same face.
  const auto change = [&](int dx, int dy) {
    std::optional<double> least;
    for (const int sign : {1, -1}) {
      const int nx = x + sign * dx, ny = y + sign * dy;
      if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height || !holds(*image.at(nx, ny))) continue;
      const double apart = std::abs(double(*image.at(nx, ny)) - stored);
      least = std::min(least.value_or(apart), apart);
    }
    return least.value_or(0);
  };
  const double slope = map.depthBiasSlope != 0 ? std::max(change(1, 0), change(0, 1)) : 0;
  // The nearer neighbor shows 73 % of a sphere's slope at its limb.
  constexpr double kMissed = 0.3;
  return {stored - map.depthBiasConstant - map.depthBiasSlope * slope,
          map.depthStep / 2 + std::abs(map.depthBiasSlope) * (map.depthStep + kMissed * slope)};
}

}  // namespace pellucid::harness::reference
