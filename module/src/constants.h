// Offsets in the constants slice.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct Setup;
struct Lights;
struct Stages;
struct Blocks;

// The largest offset alignment that Vulkan allows a device to ask for.
constexpr VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 255) / 256 * 256; }

constexpr VkDeviceSize kLightWindow = PELLUCID_DISPATCH_LIGHTS * sizeof(shared::LightConstants);
constexpr VkDeviceSize kShadowWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::ShadowConstants);
constexpr VkDeviceSize kGatherMapWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::GatherMapConstants);
constexpr VkDeviceSize kEntryMapWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::EntryMapConstants);
static_assert(aligned(kLightWindow) <= 16384 && aligned(kShadowWindow) <= 16384 &&
              kGatherMapWindow <= kShadowWindow);  // least maxUniformBufferRange

// Bytes from the slice's begin.
struct ConstantsLayout {
  VkDeviceSize frame = 0, lights = 0, shadows = 0, materials = 0, kernels = 0;
  VkDeviceSize gatherMaps = 0, entryMaps = 0;  // of frames that gather
  VkDeviceSize lists = 0;                      // BlockLists, the last of the slice; without diffusion its end
  VkDeviceSize size = 0;

  ConstantsLayout(const Setup& setup, const Lights& all, const Stages& stages, const Blocks& blocks);
};

}  // namespace pellucid
