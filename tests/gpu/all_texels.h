// The float64 gather over all texels of the maps, which no samples stand for.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "capture/capture.h"
#include "common/parallel.h"
#include "reference/gather.h"

namespace pellucid::test {

// At the pixels that `wanted` names, added to what the diffusion made; 0 elsewhere.
inline harness::Image allTexels(const harness::Capture& c, const std::vector<PellucidMaterial>& materials,
                                const harness::Image& diffused,
                                const std::function<bool(int x, int y)>& wanted) {
  const harness::reference::SurfaceReader surfaces(c);
  const harness::reference::Gather gather(c, surfaces, materials);
  harness::Image out(c.width, c.height, 3);
  harness::parallelRows(c.height, 0, [&](int y) {
    for (int x = 0; x < c.width; ++x) {
      const size_t i = static_cast<size_t>(y * c.width + x);
      const auto surface = surfaces.at(x, y);
      if (c.material[i] == 0 || !surface || !wanted(x, y)) continue;
      const harness::reference::Gathered g = gather.at(*surface, c.material[i] - 1u);
      for (int k = 0; k < 3; ++k)
        out.at(x, y)[k] = static_cast<float>(
            std::max(0.0, g.factor[k] * double(diffused.at(x, y)[k]) + g.returned[k] +
                              g.transmitted[k] / double(materials[c.material[i] - 1u].reflectance[k])));
    }
  });
  return out;
}

}  // namespace pellucid::test
