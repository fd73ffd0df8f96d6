#include "materials.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

double widestDeviation(const PellucidMaterial& m) {
  double variance = 0;
  for (int c = 0; c < 3; ++c)
    for (uint32_t i = 0; i < m.gaussianCount; ++i)
      if (m.gaussianWeight[c][i] > 0)
        variance = std::max(variance, static_cast<double>(m.gaussianVariance[c][i]));
  return std::sqrt(variance);
}

Materials::Materials(const Inputs& inputs, const Screen& screen) {
  const PellucidFrame& frame = inputs.frame;
  const double mmPerPixel =
      pixelSide(screen.clipFromView, screen.depthRange, {frame.imageExtent[0], frame.imageExtent[1]},
                static_cast<double>(frame.options.nearestDistance)) *
      static_cast<double>(frame.metersPerUnit) * 1000;
  // No infinity may reach the plan's text.
  reach.pixelsPerMm = mmPerPixel > 0 ? std::min(1 / mmPerPixel, 1e30) : 0;
  const auto pixels = [&](double mm) { return std::min(mm * reach.pixelsPerMm, 1e30); };
  for (uint32_t i = 0; i < frame.materialCount; ++i) {
    const PellucidMaterial m = inputs.diffused(i);
    (m.thinWalled != 0 ? thinWalls : solids) = true;
    if (m.gaussianCount == 0) continue;
    diffuses = true;
    reach.radius =
        std::max(reach.radius, pixels(static_cast<double>(*std::max_element(m.radius, m.radius + 3))));
    reach.deviation = std::max(reach.deviation, pixels(widestDeviation(m)));
  }
}

}  // namespace pellucid
