// A frame as this engine knows it: what pellucid_pass.h needs of an engine. Vulkan, GLM and Pellucid suffice for both.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::sample {

constexpr std::uint32_t kFramesInFlight = 3, kMostMaterials = 255, kMostLights = 6, kMostTiles = 16,
                        kShadowImages = 4;
// Arrays of layers. kFronts has the tiles of kAtlas with front faces and without bias, for Pellucid alone: Frame::hasFronts. Culled
// cascades and cubes would need such an image each.
enum ShadowImage : std::uint32_t { kCascades, kAtlas, kCube, kFronts };

// A square of one of the shadow images. Depths are reversed: 1 is near.
struct ShadowTile {
  std::uint32_t image = kCascades, layer = 0, x = 0, y = 0, size = 0;  // texels
  glm::dmat4 clipFromWorld{1};
  double texel = 0;  // side of a texel in scene units at clip w 1
  bool frontsCulled = false;
  float biasConstant = 0, biasSlope = 0;  // as vkCmdSetDepthBias takes them
  float depthStep = 0;                    // of stored depths
};

// The engine keeps images as views with their layouts, and lights by the names and units of
// KHR_lights_punctual: both are Pellucid's types.
struct Frame {
  std::uint64_t index = 0;
  VkExtent2D extent{}, rect{};  // pixels of the images, and those rendered, from the images' corner
  glm::dmat4 clipFromView, viewFromWorld;  // of the rect; clipFromView with jitter
  glm::vec4 lookedAt{};  // world point that the camera looks at, w 1
  float metersPerUnit = 1;
  float preExposure = 1;  // the irradiance image holds E times this
  PellucidImage normal{}, albedo{}, surface{}, depth{}, backDepth{}, irradiance{}, color{};
  std::array<PellucidImage, kShadowImages> shadows{};
  std::vector<PellucidLight> lights;
  std::vector<ShadowTile> tiles;
  bool hasFronts = false;
  bool hasAmbient = false;
  std::array<glm::vec3, 9> ambient{};  // coefficients of radiance
  std::uint32_t gatherSamples = 8;
  bool ownQueue = false;  // Pellucid's commands have a submission of their own, between semaphores
  // At least PellucidPass::sliceSize() bytes of a mapped buffer, uniform, storage and indirect, for this frame alone:
  // the GPU still reads the slices of the frames in flight.
  PellucidConstantsSlice constants{};
  // An image of that format and extent, usage SAMPLED | STORAGE, layout GENERAL, for this frame alone.
  std::function<PellucidImage(const PellucidImageNeed&)> transient;
};

}  // namespace pellucid::sample
