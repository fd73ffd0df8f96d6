// A frame as this engine knows it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "capture/capture.h"
#include "common/device.h"
#include "common/error.h"
#include "pellucid/pellucid.h"
#include "raster/render_target.h"

namespace pellucid::sample {

using namespace pellucid::harness;

constexpr std::uint32_t kFramesInFlight = 3, kMostMaterials = 255, kMostLights = 6, kMostTiles = 16,
                        kShadowImages = 4;
// Arrays of layers. kFronts has the tiles of kAtlas with front faces, for Pellucid alone: Frame::hasFronts.
enum ShadowImage : std::uint32_t { kCascades, kAtlas, kCube, kFronts };

// A square of one of the shadow images. Depths are reversed: 1 is near.
struct ShadowTile {
  std::uint32_t image = kCascades, layer = 0, x = 0, y = 0, size = 0;  // texels
  glm::dmat4 clipFromWorld{1};
  double texel = 0;  // its side in scene units, per clip w
  bool frontsCulled = false;
  float biasConstant = 0, biasSlope = 0;  // as vkCmdSetDepthBias takes them
  float depthStep = 0;                    // of stored depths
};

// The layout of a depth buffer that shaders read; other images are in GENERAL throughout.
constexpr VkImageLayout kDepthRead = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;

// Usages of buffers for whatever passes compute with.
constexpr VkBufferUsageFlags kConstantsUsage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

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
  std::uint32_t gatherSamples = 8;     // of Pellucid
  bool ownQueue = false;  // Pellucid's commands have a submission of their own, between semaphores
  // An image of that format and extent, usage SAMPLED | STORAGE, layout GENERAL, for this frame alone.
  std::function<PellucidImage(const PellucidImageNeed&)> transient;
};

}  // namespace pellucid::sample
