// Names and types of the shaders' bindings. A number of compute/shared/pellucid_shared.h is one binding in
// all passes.
#pragma once

#include <array>

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct Binding {
  uint32_t number;
  const char* name;  // as in pellucidBindingName
  VkDescriptorType type;
};

inline constexpr VkDescriptorType kUniforms = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                  kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                  kStored = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// By number.
inline constexpr std::array<Binding, PELLUCID_BINDING_COUNT> kBindings = {{
    {PELLUCID_BINDING_FRAME, "frame", kUniforms},
    {PELLUCID_BINDING_LIGHTS, "lights", kUniforms},
    {PELLUCID_BINDING_SHADOWS, "shadows", kUniforms},
    {PELLUCID_BINDING_GATHER_MAPS, "gatherMaps", kUniforms},
    {PELLUCID_BINDING_MATERIALS, "materials", kStorage},
    {PELLUCID_BINDING_KERNELS, "kernels", kStorage},
    {PELLUCID_BINDING_ENTRY_MAPS, "entryMaps", kStorage},
    {PELLUCID_BINDING_LISTS, "lists", kStorage},
    {PELLUCID_BINDING_FRONT_DEPTH, "frontDepthImage", kSampled},
    {PELLUCID_BINDING_BACK_DEPTH, "backDepthImage", kSampled},
    {PELLUCID_BINDING_NORMAL, "normalImage", kSampled},
    {PELLUCID_BINDING_ALBEDO, "albedoImage", kSampled},
    {PELLUCID_BINDING_MATERIAL, "materialImage", kSampled},
    {PELLUCID_BINDING_SOURCE, "sourceImage", kSampled},
    {PELLUCID_BINDING_HELD, "heldImage", kSampled},
    {PELLUCID_BINDING_HISTORY, "historyImage", kSampled},
    {PELLUCID_BINDING_PYRAMID, "pyramidImage", kSampled},
    {PELLUCID_BINDING_COARSER_LEVELS, "coarserLevelsImage", kSampled},
    {PELLUCID_BINDING_ENTRY_POINTS, "entriesImage", kSampled},
    {PELLUCID_BINDING_FOUND_PROBES, "foundImage", kSampled},
    {PELLUCID_BINDING_FILTERED_PROBES, "filteredProbesImage", kSampled},
    {PELLUCID_BINDING_DESTINATION, "destinationImage", kStored},
    {PELLUCID_BINDING_LEVELS, "levelsDestination", kStored},
    {PELLUCID_BINDING_ENTRIES_DESTINATION, "entriesDestination", kStored},
    {PELLUCID_BINDING_PROBES_DESTINATION, "probesImage", kStored},
    {PELLUCID_BINDING_FILTERED_DESTINATION, "sharedImage", kStored},
    {PELLUCID_BINDING_BLOCKS, "blocksImage", kStored},
    {PELLUCID_BINDING_HIDDEN_IRRADIANCE, "hiddenIrradianceImage", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES, "shadowImage0", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 1, "shadowImage1", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 2, "shadowImage2", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 3, "shadowImage3", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 4, "shadowImage4", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 5, "shadowImage5", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 6, "shadowImage6", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 7, "shadowImage7", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 8, "shadowImage8", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 9, "shadowImage9", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 10, "shadowImage10", kSampled},
    {PELLUCID_BINDING_SHADOW_IMAGES + 11, "shadowImage11", kSampled},
}};

constexpr bool isInOrder() {
  for (uint32_t i = 0; i < kBindings.size(); ++i)
    if (kBindings[i].number != i) return false;
  return true;
}
static_assert(isInOrder());

// Bits by number.
using BindingSet = uint64_t;
static_assert(PELLUCID_BINDING_COUNT <= 64);

template <class... Numbers>
constexpr BindingSet bindings(Numbers... numbers) {
  return ((BindingSet{1} << numbers) | ... | BindingSet{0});
}
constexpr BindingSet shadowImages(uint32_t count) {
  return ((BindingSet{1} << count) - 1) << PELLUCID_BINDING_SHADOW_IMAGES;
}
constexpr bool has(BindingSet set, uint32_t number) { return (set >> number & 1) != 0; }

// Calls each(const Binding&) in the order of numbers.
template <class Each>
void forEach(BindingSet set, Each&& each) {
  for (const Binding& binding : kBindings)
    if (has(set, binding.number)) each(binding);
}

}  // namespace pellucid
