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

// 32 bits a channel.
inline bool isWide(const PellucidFrame& frame) { return frame.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT; }
// Of transients and histories that hold colors.
inline VkFormat colorFormat(const PellucidFrame& frame) {
  return isWide(frame) ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
}

bool anyMaterialDiffuses(const PellucidFrame& frame);

// The largest offset alignment that Vulkan allows a device to ask for.
constexpr VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 255) / 256 * 256; }

// One fused dispatch binds PELLUCID_SHADOW_IMAGE_COUNT shadow images and windows of fixed size on the
// constants of lights and shadow maps, so lights are taken in order into groups that need no more. Constants
// are laid out light by light within the groups.
constexpr VkDeviceSize kLightWindow = PELLUCID_DISPATCH_LIGHTS * sizeof(shared::LightConstants);
constexpr VkDeviceSize kShadowWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::ShadowConstants);
constexpr VkDeviceSize kGatherMapWindow = PELLUCID_DISPATCH_SHADOWS * sizeof(shared::GatherMapConstants);
static_assert(kLightWindow <= 16384 && kShadowWindow <= 16384 &&
              kGatherMapWindow <= kShadowWindow);  // least maxUniformBufferRange

struct LightGroup {
  uint32_t firstLight = 0, lightCount = 0;       // among the lights that are not skipped
  uint32_t shadowCount = 0;                      // shadow maps
  VkDeviceSize lightBytes = 0, shadowBytes = 0;  // of the groups before, in the constants
  VkDeviceSize gatherMapBytes = 0, entryMapBytes = 0;
  uint32_t gathered = 0;                     // lights that are gathered from; the first ones
  uint32_t entryColumns = 0, entryRows = 0;  // of their maps' entry points
  uint32_t entryWidth = 0, entryHeight = 0;  // the most that one of them has
  bool beside = true;                        // exit depths and caster materials have slots among the images
  uint32_t imageCount = 0;
  std::array<uint32_t, PELLUCID_SHADOW_IMAGE_COUNT> images{};  // into frame.shadowImages

  // Slot of an image, or PELLUCID_SHADOW_IMAGE_COUNT.
  uint32_t slot(uint32_t image) const;
  // Gives the images of a light's map slots; false if there are not enough.
  bool addImages(const PellucidFrame& frame, const PellucidLight& light, const PellucidShadowMap& map);
  // Whether what lies beside the light's map is read. Thickness from the camera knows nothing of the light's
  // way and its exit.
  bool readsExit(const PellucidFrame& frame, const PellucidLight& light, const PellucidShadowMap& map) const;
  bool readsCaster(const PellucidShadowMap& map) const { return beside && map.casterMaterialImage != 0; }

private:
  bool addImage(uint32_t image);
};

// True for transmittance models that the gather's kernel follows from.
inline bool canBeGathered(uint32_t transmittanceModel) {
  return transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2 ||
         transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP;
}

// The samples of each point, by frame.quality if that chooses.
uint32_t gatherSamples(const PellucidFrame& frame);

// Why frame.quality cannot choose a gather, for the plan's skips; NULL: it can.
const char* whyNotGathered(const PellucidFrame& frame);

// Whether lights with a map are gathered from.
inline bool gathers(const PellucidFrame& frame) {
  return (frame.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0 && gatherSamples(frame) > 0 &&
         frame.debugView == PELLUCID_DEBUG_NONE;
}
inline bool isGathered(const PellucidFrame& frame, const PellucidLight& light) {
  return light.shadowMapCount > 0 && gathers(frame);
}

// Pixels a side of what one point of the gather stands for.
uint32_t gatherSpacing(const PellucidFrame& frame);

// Adds the light's maps to the group; false (and no change) if they do not fit.
bool addLight(const PellucidFrame& frame, const PellucidLight& light, LightGroup* group);

// Whether the frame's dispatches can bind what lies beside its maps, which makes for more groups: else it is
// left out as if the frame had only the maps.
bool bindsBeside(const PellucidFrame& frame);

// forEachLightGroup with what lies beside maps or without.
template <class OnLight, class OnGroup>
void forEachLightGroup(const PellucidFrame& frame, bool beside, OnLight&& light, OnGroup&& group) {
  LightGroup current;
  current.beside = beside;
  const ViewBounds view(frame);
  for (const bool gathered : {true, false})
    for (uint32_t i = 0; i < frame.lightCount; ++i) {
      if (isGathered(frame, frame.lights[i]) != gathered || view.whySkipped(frame.lights[i])) continue;
      if (!addLight(frame, frame.lights[i], &current)) {
        group(static_cast<const LightGroup&>(current));
        LightGroup next;
        next.beside = beside;
        next.firstLight = current.firstLight + current.lightCount;
        next.lightBytes = current.lightBytes + aligned(current.lightCount * sizeof(shared::LightConstants));
        next.shadowBytes =
            current.shadowBytes + aligned(current.shadowCount * sizeof(shared::ShadowConstants));
        next.gatherMapBytes =
            current.gatherMapBytes + aligned(current.shadowCount * sizeof(shared::GatherMapConstants));
        next.entryMapBytes =
            current.entryMapBytes + aligned(current.shadowCount * sizeof(shared::EntryMapConstants));
        current = next;
        addLight(frame, frame.lights[i], &current);
      }
      light(static_cast<const LightGroup&>(current), frame.lights[i]);
    }
  if (current.lightCount > 0) group(static_cast<const LightGroup&>(current));
}
// Calls group(const LightGroup&) for each group in order, and light(const LightGroup&, const
// PellucidLight&) for each light as it is placed. Those that are gathered from come first: all of them are
// added to the pixels at once.
template <class OnLight, class OnGroup>
void forEachLightGroup(const PellucidFrame& frame, OnLight&& light, OnGroup&& group) {
  forEachLightGroup(frame, bindsBeside(frame), light, group);
}
template <class OnGroup>
void forEachLightGroup(const PellucidFrame& frame, OnGroup&& group) {
  forEachLightGroup(
      frame, [](const LightGroup&, const PellucidLight&) {}, group);
}

// Whether thickness along view rays is asked for: lights without shadow maps have no other, and the debug
// view of thickness shows it.
bool needsChord(const PellucidFrame& frame);

struct LightGroups {
  uint32_t count = 0, gathered = 0;          // gathered: with lights that are gathered from
  uint32_t entryColumns = 0, entryRows = 0;  // the most of a group
  // Dispatches besides those over all pixels.
  uint32_t gatherDispatches() const { return gathered > 0 ? 2 * gathered + 1 : 0; }
  // Dispatches over all pixels. What is gathered in several groups is added at once.
  uint32_t fused() const { return count - (gathered > 0 ? gathered - 1 : 0); }
};

LightGroups lightGroups(const PellucidFrame& frame);

// Whether all light that comes through is gathered, in one group and for every pixel with a material: then
// what adds it needs nothing else of the pixels.
bool addsProbes(const PellucidFrame& frame);

// Byte ranges of the constants slice.
struct ConstantsLayout {
  struct Range {
    VkDeviceSize offset, size;
  };
  Range frame, lights, shadows, materials, kernels;
  Range gatherMaps, entryMaps, gatherDispatches;  // of frames that gather
  VkDeviceSize size;
  uint32_t lightCount;
};

ConstantsLayout constantsLayout(const PellucidFrame& frame);

}  // namespace pellucid
