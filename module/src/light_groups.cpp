#include "light_groups.h"

#include <algorithm>

#include "entry_points.h"
#include "frame.h"

namespace pellucid {

uint32_t LightGroup::slot(uint32_t image) const {
  for (uint32_t i = 0; i < imageCount; ++i)
    if (images[i] == image) return i;
  return mostImages;
}

bool LightGroup::addImage(uint32_t image) {
  if (slot(image) < mostImages) return true;
  if (imageCount == mostImages) return false;
  images[imageCount++] = image;
  return true;
}

bool LightGroup::addImages(const FrameFacts& facts, const PellucidLight& light,
                           const PellucidShadowMap& map) {
  return addImage(map.image) && (!readsExit(facts, light, map) || addImage(map.exitImage - 1)) &&
         (!readsCaster(map) || addImage(map.casterMaterialImage - 1));
}

bool LightGroup::readsExit(const FrameFacts& facts, const PellucidLight& light,
                           const PellucidShadowMap& map) const {
  return beside && map.exitImage != 0 && map.faces == PELLUCID_FACES_FRONT &&
         (facts.frame.thicknessSource == PELLUCID_THICKNESS_LIGHT || facts.isGathered(light));
}

bool LightGroup::addLight(const FrameFacts& facts, const PellucidLight& light) {
  const PellucidFrame& frame = facts.frame;
  // Probes and the pass of one thickness a pixel take groups of their own.
  if (hasProbes() && !facts.isGathered(light)) return false;
  LightGroup grown = *this;
  // Dispatches of thin walls' light would read the images, too.
  if (facts.isGathered(light) && !facts.thinWalls) grown.mostImages = PELLUCID_ENTRY_IMAGE_COUNT;
  grown.shadowCount += light.shadowMapCount;
  if (lightCount == PELLUCID_DISPATCH_LIGHTS || grown.shadowCount > PELLUCID_DISPATCH_SHADOWS) return false;
  for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
    const PellucidShadowMap& map = frame.shadowMaps[light.firstShadowMap + i];
    if (!grown.addImages(facts, light, map)) return false;
  }
  if (facts.isGathered(light)) {
    for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
      const EntryExtent extent = entryExtent(facts, light, i);
      grown.entryColumns = std::max(grown.entryColumns, entryGroups(extent.width));
      grown.entryRows += entryGroups(extent.height);
      grown.entryWidth = std::max(grown.entryWidth, extent.width);
      grown.entryHeight = std::max(grown.entryHeight, extent.height);
    }
    if (grown.entryRows > kEntryRows) return false;
    ++grown.gathered;
  }
  ++grown.lightCount;
  *this = grown;
  return true;
}

LightGroup LightGroup::next() const {
  LightGroup next;
  next.beside = beside;
  next.firstLight = firstLight + lightCount;
  next.lightBytes = lightBytes + aligned(lightCount * sizeof(shared::LightConstants));
  next.shadowBytes = shadowBytes + aligned(shadowCount * sizeof(shared::ShadowConstants));
  next.gatherMapBytes = gatherMapBytes + aligned(shadowCount * sizeof(shared::GatherMapConstants));
  next.entryMapBytes = entryMapBytes + aligned(shadowCount * sizeof(shared::EntryMapConstants));
  return next;
}

LightGroups::LightGroups(const FrameFacts& facts, bool withBeside) : beside(withBeside) {
  facts.placeLights(
      beside, [this](const LightGroup&, const PellucidLight&) { ++lightCount; },
      [this](const LightGroup& group) {
        if (count < first.size()) first[count] = group;
        last = group;
        ++count;
        if (group.hasProbes()) ++gathered;
        entryColumns = std::max(entryColumns, group.entryColumns);
        entryRows = std::max(entryRows, group.entryRows);
      });
}

uint32_t LightGroups::walls(const FrameFacts& facts) const {
  if (!facts.gathers || !facts.thinWalls || lightCount == 0) return 0;
  return count - (first[0].lightCount == 0 ? 1 : 0);
}

LightGroups LightGroups::of(const FrameFacts& facts) {
  const PellucidFrame& frame = facts.frame;
  const LightGroups groups(facts, true);
  const auto hasNothing = [](const PellucidShadowMap& map) {
    return map.exitImage == 0 && map.casterMaterialImage == 0;
  };
  if (std::all_of(frame.shadowMaps, frame.shadowMaps + frame.shadowMapCount, hasNothing)) return groups;
  // At most: three dispatches that downsample, base level, upsample, two that diffuse, history.
  constexpr uint32_t kOthers = 8;
  // Debug views of light need all lights in one dispatch.
  const bool binds = facts.debug() && frame.debugView != PELLUCID_DEBUG_IRRADIANCE
                         ? groups.count <= 1
                         : groups.fused() + groups.gatherDispatches() + groups.walls(facts) + kOthers <=
                               PELLUCID_MAX_DISPATCHES;
  return binds ? groups : LightGroups(facts, false);
}

}  // namespace pellucid
