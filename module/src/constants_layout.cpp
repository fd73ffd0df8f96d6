#include "constants_layout.h"

#include "frame.h"

namespace pellucid {

ConstantsLayout::ConstantsLayout(const FrameFacts& facts) {
  const LightGroup& last = facts.lights.last;
  const auto place = [this](Range* range, VkDeviceSize bytes) {
    *range = {size, bytes};
    size += aligned(bytes);
  };
  place(&frame, sizeof(shared::FrameConstants));
  // The last group's window reaches as far as the first one's.
  place(&lights, last.lightBytes + kLightWindow);
  place(&shadows, last.shadowBytes + kShadowWindow);
  place(&materials, facts.frame.materialCount * sizeof(shared::MaterialConstants));
  place(&kernels, facts.frame.materialCount * sizeof(shared::KernelConstants));
  if (facts.gathers) {
    place(&gatherMaps, last.gatherMapBytes + kGatherMapWindow);
    place(&entryMaps, last.entryMapBytes + PELLUCID_DISPATCH_SHADOWS * sizeof(shared::EntryMapConstants));
    if (!facts.stages.tiles) place(&gatherDispatches, sizeof(shared::GatherDispatches));
  }
  if (facts.stages.tiles) {
    place(&tileCommands,
          sizeof(shared::TileCommands) + facts.tiles.maps * PELLUCID_ENTRY_GROUP_WORDS * sizeof(uint32_t));
    gatherDispatches = {tileCommands.offset, sizeof(shared::GatherDispatches)};
  }
}

}  // namespace pellucid
