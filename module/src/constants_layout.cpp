#include "constants_layout.h"

#include <algorithm>

namespace pellucid {

ConstantsLayout::ConstantsLayout(const Inputs& inputs, const GatherChoice& gather, const Lights& all,
                                 const Stages& stages, const Blocks& blocks) {
  const LightGroup& last = all.last;
  const auto place = [this](Range* range, VkDeviceSize bytes) {
    *range = {size, bytes};
    size += aligned(bytes);
  };
  place(&frame, sizeof(shared::FrameConstants));
  // The last group's window reaches as far as the first one's.
  place(&lights, last.lightBytes + kLightWindow);
  place(&shadows, last.shadowBytes + kShadowWindow);
  place(&materials, inputs.frame.materialCount * sizeof(shared::MaterialConstants));
  place(&kernels, inputs.frame.materialCount * sizeof(shared::KernelConstants));
  if (gather.gathers) {
    place(&gatherMaps, last.gatherMapBytes + kGatherMapWindow);
    place(&entryMaps, last.entryMapBytes + kEntryMapWindow);
  }
  if (stages.diffusion)
    place(&lists, sizeof(shared::BlockLists) + blocks.maps * PELLUCID_ENTRY_GROUP_WORDS * sizeof(uint32_t));
}

namespace {

// A plan holds no more groups of lights than dispatches.
VkDeviceSize mostConstants(VkDeviceSize materials, VkDeviceSize lights, VkDeviceSize maps) {
  const VkDeviceSize groups = std::clamp(lights, VkDeviceSize{1}, VkDeviceSize{PELLUCID_MAX_DISPATCHES});
  // The bytes that a range holds of the groups before the last one, each rounded up, and the last one's
  // window.
  const auto grouped = [groups](VkDeviceSize bytes, VkDeviceSize window) {
    return aligned(bytes + (groups - 1) * (aligned(1) - 1) + window);
  };
  return aligned(sizeof(shared::FrameConstants)) + aligned(materials * sizeof(shared::MaterialConstants)) +
         aligned(materials * sizeof(shared::KernelConstants)) +
         grouped(lights * sizeof(shared::LightConstants), kLightWindow) +
         grouped(maps * sizeof(shared::ShadowConstants), kShadowWindow) +
         grouped(maps * sizeof(shared::GatherMapConstants), kGatherMapWindow) +
         grouped(maps * sizeof(shared::EntryMapConstants), kEntryMapWindow) +
         aligned(sizeof(shared::BlockLists) + maps * PELLUCID_ENTRY_GROUP_WORDS * sizeof(uint32_t));
}

}  // namespace
}  // namespace pellucid

extern "C" VkDeviceSize pellucidGetConstantsSize(uint32_t materialCount, uint32_t lightCount,
                                                 uint32_t shadowMapCount) {
  // Ambient light is one more.
  return pellucid::mostConstants(materialCount, VkDeviceSize{lightCount} + 1, shadowMapCount);
}
