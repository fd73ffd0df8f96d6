#include "cli/nearest_distance.h"

#include <optional>
#include <sstream>

#include "common/error.h"
#include "reference/camera.h"

namespace pellucid::harness {

void requireNearestDistance(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                            const ReplaySettings& settings) {
  if (!(settings.nearestDistance > 0) || !(settings.features & PELLUCID_FEATURE_DIFFUSION)) return;
  const auto diffuses = [&](std::uint32_t value) {
    const std::uint32_t id = value & ~settings.translucency.materialMarkBit;
    return id > 0 && id <= materials.size() && materials[id - 1].gaussianCount > 0;
  };
  const reference::Camera camera(capture.clipFromView, capture.width, capture.height);
  if (camera.orthographic()) return;  // radii in pixels are the same at any distance
  std::optional<double> nearest;
  int nearestX = 0, nearestY = 0;
  for (int y = 0; y < capture.height; ++y)
    for (int x = 0; x < capture.width; ++x) {
      if (!diffuses(capture.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(capture.width) +
                                     static_cast<std::size_t>(x)]))
        continue;
      const std::optional<double> depth =
          camera.planarDepth(capture.frontDepth.image.at(x, y)[0], capture.frontDepth.encoding);
      if (!depth || (nearest && *depth >= *nearest)) continue;
      nearest = depth;
      nearestX = x;
      nearestY = y;
    }
  if (!nearest || *nearest >= static_cast<double>(settings.nearestDistance) * (1 - 1e-4)) return;
  std::ostringstream sentence;
  sentence << "is " << settings.nearestDistance << ", but at pixel " << nearestX << ", " << nearestY
           << " a surface that diffuses lies at " << *nearest;
  throw InputError(capture.name, "nearest-distance", sentence.str());
}

}  // namespace pellucid::harness
