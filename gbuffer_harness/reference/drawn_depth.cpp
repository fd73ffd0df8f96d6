#include "reference/drawn_depth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pellucid::harness::reference {

DrawnDepth drawnDepth(const ShadowMap& map, int x, int y, const std::function<bool(float)>& holds) {
  const Image& image = map.depth.image;
  const double stored = double(*image.at(x, y)), bias = map.depthBiasSlope;
  if (bias == 0) return {stored - map.depthBiasConstant, map.depthStep / 2};
  const auto neighbors = [&](int dx, int dy) {
    std::vector<double> depths;
    for (const int sign : {1, -1}) {
      const int nx = x + sign * dx, ny = y + sign * dy;
      if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height || !holds(*image.at(nx, ny))) continue;
      depths.push_back(double(*image.at(nx, ny)));
    }
    return depths;
  };
  const std::vector<double> axes[] = {neighbors(1, 0), neighbors(0, 1)};
  // The light grazes a triangle whose bias moves it behind both of a texel's neighbors.
  double moved = 0;
  for (const std::vector<double>& n : axes)
    if (n.size() == 2) {
      const double nearest = bias > 0 ? std::max(n[0], n[1]) : std::min(n[0], n[1]);
      moved = std::max(moved, (bias > 0 ? 1 : -1) * (stored - nearest));
    }
  const double own = stored - (bias > 0 ? moved : -moved);
  // Vulkan 1.3, "Depth Bias": the larger of the changes along x and y. Along each axis the nearer neighbor is
  // more likely of the same face; it shows 73 % of a sphere's slope at its limb.
  constexpr double kMissed = 0.3;
  double slope = 0, missed = 0;
  for (const std::vector<double>& n : axes) {
    if (n.empty()) continue;
    double least = std::abs(n[0] - own), other = least;
    if (n.size() == 2) {
      least = std::min(least, std::abs(n[1] - own));
      other = std::abs(n[0] + n[1] - 2 * own);
    }
    slope = std::max(slope, least);
    missed = std::max({missed, kMissed * least, other});
  }
  return {own - map.depthBiasConstant - bias * slope,
          map.depthStep / 2 + std::abs(bias) * (map.depthStep + missed)};
}

}  // namespace pellucid::harness::reference
