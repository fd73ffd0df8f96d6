// Byte ranges of the constants slice.
#pragma once

#include "stages.h"

namespace pellucid {

// The largest offset alignment that Vulkan allows a device to ask for.
constexpr VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 255) / 256 * 256; }

constexpr VkDeviceSize kLightWindow = PELLUCID_DISPATCH_LIGHTS * sizeof(shared::LightConstants);
constexpr VkDeviceSize kShadowWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::ShadowConstants);
constexpr VkDeviceSize kGatherMapWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::GatherMapConstants);
constexpr VkDeviceSize kEntryMapWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::EntryMapConstants);
static_assert(kLightWindow <= 16384 && kShadowWindow <= 16384 &&
              kGatherMapWindow <= kShadowWindow);  // least maxUniformBufferRange

// Byte ranges of the constants slice.
struct ConstantsLayout {
  struct Range {
    VkDeviceSize offset, size;
  };
  Range frame{}, lights{}, shadows{}, materials{}, kernels{};
  Range gatherMaps{}, entryMaps{};  // of frames that gather
  Range lists{};                    // of frames that diffuse: BlockLists
  VkDeviceSize size = 0;

  ConstantsLayout(const Inputs& inputs, const GatherChoice& gather, const Lights& all, const Stages& stages,
                  const Blocks& blocks);
};

}  // namespace pellucid
