#include "frame.h"

#include <algorithm>

#include "entry_points.h"
#include "quality.h"

namespace pellucid {

Rect renderRect(const PellucidFrame& frame) {
  if (frame.renderRect[2] == 0) return {0, 0, frame.imageExtent[0], frame.imageExtent[1]};
  return {frame.renderRect[0], frame.renderRect[1], frame.renderRect[2], frame.renderRect[3]};
}

bool anyMaterialDiffuses(const PellucidFrame& frame) {
  for (uint32_t i = 0; i < frame.materialCount; ++i)
    if (frame.materials[i].gaussianCount > 0) return true;
  return false;
}

uint32_t LightGroup::slot(uint32_t image) const {
  for (uint32_t i = 0; i < imageCount; ++i)
    if (images[i] == image) return i;
  return PELLUCID_SHADOW_IMAGE_COUNT;
}

bool LightGroup::addImage(uint32_t image) {
  if (slot(image) < PELLUCID_SHADOW_IMAGE_COUNT) return true;
  if (imageCount == PELLUCID_SHADOW_IMAGE_COUNT) return false;
  images[imageCount++] = image;
  return true;
}

bool LightGroup::addImages(const PellucidFrame& frame, const PellucidLight& light,
                           const PellucidShadowMap& map) {
  return addImage(map.image) && (!readsExit(frame, light, map) || addImage(map.exitImage - 1)) &&
         (!readsCaster(map) || addImage(map.casterMaterialImage - 1));
}

bool LightGroup::readsExit(const PellucidFrame& frame, const PellucidLight& light,
                           const PellucidShadowMap& map) const {
  return beside && map.exitImage != 0 &&
         (frame.thicknessSource == PELLUCID_THICKNESS_LIGHT || isGathered(frame, light));
}

bool addLight(const PellucidFrame& frame, const PellucidLight& light, LightGroup* group) {
  LightGroup grown = *group;
  grown.shadowCount += light.shadowMapCount;
  if (group->lightCount == PELLUCID_DISPATCH_LIGHTS || grown.shadowCount > PELLUCID_DISPATCH_SHADOWS)
    return false;
  for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
    const PellucidShadowMap& map = frame.shadowMaps[light.firstShadowMap + i];
    if (!grown.addImages(frame, light, map)) return false;
  }
  if (isGathered(frame, light)) {
    for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
      const EntryExtent extent = entryExtent(frame, light, i);
      grown.entryColumns = std::max(grown.entryColumns, entryGroups(extent.width));
      grown.entryRows += entryGroups(extent.height);
      grown.entryWidth = std::max(grown.entryWidth, extent.width);
      grown.entryHeight = std::max(grown.entryHeight, extent.height);
    }
    if (grown.entryRows > kEntryRows) return false;
    ++grown.gathered;
  }
  ++grown.lightCount;
  *group = grown;
  return true;
}

bool needsChord(const PellucidFrame& frame) {
  if (frame.thicknessSource == PELLUCID_THICKNESS_CAMERA || frame.debugView == PELLUCID_DEBUG_THICKNESS)
    return true;
  for (uint32_t i = 0; i < frame.lightCount; ++i)
    if (frame.lights[i].shadowMapCount == 0) return true;
  return false;
}

const char* whyNotGathered(const PellucidFrame& frame) {
  if (frame.thicknessSource == PELLUCID_THICKNESS_CAMERA) return "thickness comes from the camera";
  if (frame.angleModel != PELLUCID_ANGLE_NORMAL || frame.constantViewDirection != 0 ||
      frame.minimumDot != 0 || frame.maximumThickness > 0)
    return "angleModel, constantViewDirection, minimumDot and maximumThickness are of one thickness a pixel";
  for (uint32_t i = 0; i < frame.materialCount; ++i)
    if (!canBeGathered(frame.materials[i].transmittanceModel))
      return "a material's transmittance model has no profile";
  return nullptr;
}

uint32_t gatherSamples(const PellucidFrame& frame) {
  if (frame.gatherSamples != PELLUCID_GATHER_BY_QUALITY) return frame.gatherSamples;
  constexpr uint32_t kSamples[] = {0, 8, 16};
  return whyNotGathered(frame) ? 0 : kSamples[frame.quality];
}

uint32_t gatherSpacing(const PellucidFrame& frame) {
  if (frame.gatherSpacing != 0) return frame.gatherSpacing;
  const uint64_t pixels = static_cast<uint64_t>(frame.imageExtent[0]) * frame.imageExtent[1];
  const uint32_t spacing = pixels > 1u << 20 ? 4 : pixels > 1u << 19 ? 2 : 1;
  return frame.quality == kBestQuality ? std::max(spacing / 2, 1u) : spacing;
}

namespace {

LightGroups countGroups(const PellucidFrame& frame, bool beside) {
  LightGroups groups;
  forEachLightGroup(
      frame, beside, [](const LightGroup&, const PellucidLight&) {},
      [&](const LightGroup& group) {
        ++groups.count;
        if (group.gathered > 0) ++groups.gathered;
        groups.entryColumns = std::max(groups.entryColumns, group.entryColumns);
        groups.entryRows = std::max(groups.entryRows, group.entryRows);
      });
  return groups;
}

}  // namespace

bool bindsBeside(const PellucidFrame& frame) {
  const auto hasNothing = [](const PellucidShadowMap& map) {
    return map.exitImage == 0 && map.casterMaterialImage == 0;
  };
  if (std::all_of(frame.shadowMaps, frame.shadowMaps + frame.shadowMapCount, hasNothing)) return true;
  const LightGroups groups = countGroups(frame, true);
  // Debug views of light need all lights in one dispatch.
  if (frame.debugView != PELLUCID_DEBUG_NONE && frame.debugView != PELLUCID_DEBUG_IRRADIANCE)
    return groups.count <= 1;
  // At most: three reductions, quads, resolve, two that diffuse, history.
  constexpr uint32_t kOthers = 8;
  return groups.fused() + groups.gatherDispatches() + kOthers <= PELLUCID_MAX_DISPATCHES;
}

LightGroups lightGroups(const PellucidFrame& frame) { return countGroups(frame, bindsBeside(frame)); }

bool addsProbes(const PellucidFrame& frame) {
  uint32_t groups = 0, others = 0;
  forEachLightGroup(frame, [&](const LightGroup& group) {
    ++groups;
    others += group.lightCount - group.gathered;
  });
  return groups == 1 && others == 0 && frame.materialMarkBit == 0 &&
         gatherSpacing(frame) == PELLUCID_DIFFUSE_CELL;
}

ConstantsLayout constantsLayout(const PellucidFrame& frame) {
  ConstantsLayout layout{};
  LightGroup last;
  forEachLightGroup(
      frame, [&](const LightGroup&, const PellucidLight&) { ++layout.lightCount; },
      [&](const LightGroup& group) { last = group; });
  const auto place = [&layout](ConstantsLayout::Range* range, VkDeviceSize bytes) {
    range->size = bytes;
    range->offset = layout.size;
    layout.size += aligned(bytes);
  };
  place(&layout.frame, sizeof(shared::FrameConstants));
  // The last group's window reaches as far as the first one's.
  place(&layout.lights, last.lightBytes + kLightWindow);
  place(&layout.shadows, last.shadowBytes + kShadowWindow);
  place(&layout.materials, frame.materialCount * sizeof(shared::MaterialConstants));
  place(&layout.kernels, frame.materialCount * sizeof(shared::KernelConstants));
  if (gathers(frame)) {
    place(&layout.gatherMaps, last.gatherMapBytes + kGatherMapWindow);
    place(&layout.entryMaps,
          last.entryMapBytes + PELLUCID_DISPATCH_SHADOWS * sizeof(shared::EntryMapConstants));
    place(&layout.gatherDispatches, sizeof(shared::GatherDispatches));
  }
  return layout;
}

}  // namespace pellucid

extern "C" void pellucidInitFrame(PellucidFrame* frame) {
  if (!frame) return;
  *frame = PellucidFrame{};
  frame->structSize = sizeof(PellucidFrame);
  frame->features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  frame->metersPerUnit = 1;
  for (int i = 0; i < 4; ++i) frame->viewFromWorld[i * 5] = 1;
  frame->outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  for (float& factor : frame->transmittanceFilter) factor = 1;
  frame->faceVector[2] = 1;
  frame->upAxis[1] = 1;
  frame->coherenceThreshold = 0.005f;
  frame->quality = 1;
  frame->gatherSamples = PELLUCID_GATHER_BY_QUALITY;
}
