// Where the shadow maps of a frame lie, and what they see.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sample/scene.h"

namespace pellucid::sample {

constexpr std::uint32_t kCascadeCount = 4, kAtlasColumns = 2, kCubeFaces = 6;

// Cascades of the sun over what a camera sees of the scene, the nearest first. rayFromClip: the inverse of
// clipFromView of the camera; nearest and farthest: planar distances that shall be covered.
std::vector<ShadowTile> cascades(const Scene& scene, const glm::dmat4& worldFromView,
                                 const glm::dmat4& viewFromClip, std::uint32_t texels);

// Tiles of a light with fixed views: of the spot with that index in the atlas, or of the point light in the
// cube.
std::vector<ShadowTile> fixedTiles(const SceneLight& light, std::uint32_t index, std::uint32_t texels);

}  // namespace pellucid::sample
