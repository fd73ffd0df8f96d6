#include "sample/shadow_tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/vector.h"

namespace pellucid::sample {

std::vector<ShadowTile> cascades(const Scene& scene, const glm::dmat4& worldFromView,
                                 const glm::dmat4& viewFromClip, std::uint32_t texels) {
  constexpr double kBehind = 3;  // radii behind the scene that still receive shadows
  const glm::dvec3 center = toGlm(scene.bounds.center), direction = toGlm(scene.sun.light.direction);
  const double radius = scene.bounds.radius;
  const double away = -(glm::inverse(worldFromView) * glm::dvec4(center, 1)).z;
  const double first = std::max(away - radius, 0.02 * radius), last = std::max(away + radius, 2 * first);
  const glm::dmat4 light =
      toGlm(lookAt(fromGlm(center - 4 * radius * direction), scene.bounds.center, {0, 1, 0}));
  std::vector<ShadowTile> tiles;
  for (std::uint32_t i = 0; i < kCascadeCount; ++i) {
    const double from = glm::mix(first, last, static_cast<double>(i) / kCascadeCount),
                 to = i + 1 < kCascadeCount ? glm::mix(first, last, (i + 1.0) / kCascadeCount)
                                            : last + kBehind * radius;
    // A sphere around the slice of the camera's frustum: its size does not change as the camera turns.
    const auto corner = [&](double distance) {
      const glm::dvec4 ray = viewFromClip * glm::dvec4(1, 1, 1, 1);  // reversed: on the near plane
      return glm::dvec3(ray) / -ray.z * distance;
    };
    const double middle = 0.5 * (from + to), size = glm::distance(corner(to), glm::dvec3(0, 0, -middle));
    // Steps by whole texels keep edges of shadows still.
    glm::dvec3 seen = light * worldFromView * glm::dvec4(0, 0, -middle, 1);
    const double texel = 2 * size / texels;
    seen = glm::floor(seen / texel) * texel;
    const ClipRange range{0.1 * radius, (8 + kBehind) * radius, true};
    ShadowTile& tile = tiles.emplace_back(ShadowTile{kCascades, i, 0, 0, texels});
    tile.clipFromWorld = toGlm(orthographic(2 * size, 2 * size, range)) *
                         glm::translate(glm::dmat4(1), {-seen.x, -seen.y, 0.0}) * light;
    tile.texel = texel;
  }
  return tiles;
}

std::vector<ShadowTile> fixedTiles(const SceneLight& light, std::uint32_t index, std::uint32_t texels) {
  const bool spot = light.light.type == PELLUCID_LIGHT_SPOT;
  std::vector<ShadowTile> tiles;
  for (const LightView& view : light.views) {
    const std::uint32_t layer = spot ? 0 : static_cast<std::uint32_t>(tiles.size());
    ShadowTile& tile = tiles.emplace_back(ShadowTile{spot ? kAtlas : kCube, layer});
    if (spot) {
      tile.x = index % kAtlasColumns * texels;
      tile.y = index / kAtlasColumns * texels;
      tile.depthStep = 1.0f / 65535;
    }
    tile.size = texels;
    tile.clipFromWorld = toGlm(view.clipFromView) * toGlm(view.viewFromWorld);
    tile.texel = 2 / (view.clipFromView[0] * texels);
  }
  return tiles;
}

}  // namespace pellucid::sample
