// Passes as far as they are the same in all frames, and the bindings of compute/shared/pellucid_shared.h that
// they read and write.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// ---- Bindings

struct Binding {
  uint32_t number;
  const char* name;  // as in pellucidBindingName
  VkDescriptorType type;
};

inline constexpr VkDescriptorType kUniforms = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                  kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  kSampled = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                  kStored = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// By number. The list names the first shadow image.
inline constexpr std::array<Binding, PELLUCID_BINDING_COUNT> kBindings = [] {
  std::array<Binding, PELLUCID_BINDING_COUNT> all{};
#define PELLUCID_BINDING_ROW(number, value, name, type) all[value] = {value, #name, type};
  PELLUCID_BINDINGS(PELLUCID_BINDING_ROW)
#undef PELLUCID_BINDING_ROW
  constexpr const char* kShadowImages[] = {"shadowImage0", "shadowImage1", "shadowImage2",  "shadowImage3",
                                           "shadowImage4", "shadowImage5", "shadowImage6",  "shadowImage7",
                                           "shadowImage8", "shadowImage9", "shadowImage10", "shadowImage11"};
  for (uint32_t i = 0; i < PELLUCID_ENTRY_IMAGE_COUNT; ++i)
    all[PELLUCID_BINDING_SHADOW_IMAGES + i] = {PELLUCID_BINDING_SHADOW_IMAGES + i, kShadowImages[i],
                                               kSampled};
  return all;
}();

static_assert(PELLUCID_MAX_BINDING_NUMBER == PELLUCID_BINDING_COUNT - 1);
static_assert(std::all_of(kBindings.begin(), kBindings.end(),
                          [](const Binding& b) { return b.name != nullptr; }));

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

// ---- Passes

struct Pass {
  const char* pipeline;  // name
  std::span<const uint32_t> words;
  std::span<const uint32_t> wordsOfArrays = {};  // where shadow images are layers of arrays; empty: the same
  uint32_t uses;                                 // PellucidUse bits, all of which it takes to make it
  BindingSet reads, writes;
  std::span<const PellucidSpecialization> constants = {};

  constexpr BindingSet bindings() const { return reads | writes; }
  std::span<const uint32_t> wordsFor(VkImageViewType shadowViewType) const {
    return shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY && !wordsOfArrays.empty() ? wordsOfArrays : words;
  }
};

// As pellucidGetPipelineBindings has it.
inline PellucidBinding bindingOf(const Pass& pass, const Binding& b) {
  PellucidBinding result{};
  result.binding = b.number;
  result.type = b.type;
  result.writes = has(pass.writes, b.number);
  return result;
}

// Place among the packed bindings of a pass (plan.h) of one that it has and that is no shadow image.
constexpr uint32_t slotOf(const Pass& pass, uint32_t binding) {
  return static_cast<uint32_t>(std::popcount(pass.bindings() & ((BindingSet{1} << binding) - 1)));
}

// All passes. PellucidDispatch::pipeline is an index.
std::span<const Pass* const> allPasses();
inline constexpr size_t kMostPasses = 32;

// The most bindings of the type that a pass has, and the most of all types.
uint32_t mostBindings(VkDescriptorType type);
uint32_t mostBindings();

}  // namespace pellucid
