// What planning, validation and the constants agree on about a frame. Pure.
#pragma once

#include <array>

#include "cull.h"
#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct Rect {
  uint32_t x, y, width, height;
};

Rect renderRect(const PellucidFrame& frame);

inline bool given(const PellucidImage& image) { return image.view != VK_NULL_HANDLE; }

bool anyMaterialDiffuses(const PellucidFrame& frame);

// One fused dispatch binds PELLUCID_SHADOW_IMAGE_COUNT shadow images and windows of fixed size on the
// constants of lights and shadow maps, so lights are taken in order into groups that need no more. Constants
// are laid out light by light within the groups.
constexpr VkDeviceSize kLightWindow = PELLUCID_DISPATCH_LIGHTS * sizeof(shared::LightConstants);
constexpr VkDeviceSize kShadowWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::ShadowConstants);
static_assert(kLightWindow <= 16384 && kShadowWindow <= 16384);  // least maxUniformBufferRange

// The largest offset alignment that Vulkan allows a device to ask for.
constexpr VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 255) / 256 * 256; }

struct LightGroup {
  uint32_t firstLight = 0, lightCount = 0;       // among the lights that are not skipped
  bool directional = true;   // every light is directional with one shadow map of device depth
  uint32_t shadowCount = 0;                      // shadow maps
  VkDeviceSize lightBytes = 0, shadowBytes = 0;  // of the groups before, in the constants
  uint32_t imageCount = 0;
  std::array<uint32_t, PELLUCID_SHADOW_IMAGE_COUNT> images{};  // into frame.shadowImages

  // Slot of an image, or PELLUCID_SHADOW_IMAGE_COUNT.
  uint32_t slot(uint32_t image) const {
    for (uint32_t i = 0; i < imageCount; ++i)
      if (images[i] == image) return i;
    return PELLUCID_SHADOW_IMAGE_COUNT;
  }
};

// Adds the light's maps to the group; false (and no change) if they do not fit.
bool addLight(const PellucidFrame& frame, const PellucidLight& light, LightGroup* group);

// Calls group(const LightGroup&) for each group in order, and light(const LightGroup&, const
// PellucidLight&) for each light as it is placed.
template <class OnLight, class OnGroup>
void forEachLightGroup(const PellucidFrame& frame, OnLight&& light, OnGroup&& group) {
  LightGroup current;
  const ViewBounds view(frame);
  for (uint32_t i = 0; i < frame.lightCount; ++i) {
    if (view.whySkipped(frame.lights[i])) continue;
    if (!addLight(frame, frame.lights[i], &current)) {
      group(static_cast<const LightGroup&>(current));
      LightGroup next;
      next.firstLight = current.firstLight + current.lightCount;
      next.lightBytes = current.lightBytes + aligned(current.lightCount * sizeof(shared::LightConstants));
      next.shadowBytes = current.shadowBytes + aligned(current.shadowCount * sizeof(shared::ShadowConstants));
      current = next;
      addLight(frame, frame.lights[i], &current);
    }
    light(static_cast<const LightGroup&>(current), frame.lights[i]);
  }
  if (current.lightCount > 0) group(static_cast<const LightGroup&>(current));
}

// Whether thickness along view rays is asked for: lights without shadow maps have no other, and the debug view
// of thickness shows it.
bool needsChord(const PellucidFrame& frame);

// How many fused dispatches the lights need; 0 without lights.
uint32_t lightGroupCount(const PellucidFrame& frame);

// Byte ranges of the constants slice.
struct ConstantsLayout {
  struct Range {
    VkDeviceSize offset, size;
  };
  Range frame, lights, shadows, materials, kernels;
  VkDeviceSize size;
  uint32_t lightCount;
};

ConstantsLayout constantsLayout(const PellucidFrame& frame);

}  // namespace pellucid
