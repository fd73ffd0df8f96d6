// The bindings of compute/shared/pellucid_shared.h, and sets of them.
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

// By number. The list names the first shadow image.
inline constexpr std::array<Binding, PELLUCID_BINDING_COUNT> kBindings = [] {
  std::array<Binding, PELLUCID_BINDING_COUNT> all{};
#define PELLUCID_BINDING_ROW(number, value, name, type) all[value] = {value, #name, type};
  PELLUCID_BINDINGS(PELLUCID_BINDING_ROW)
#undef PELLUCID_BINDING_ROW
  constexpr const char* kShadowImages[] = {"shadowImage0", "shadowImage1",  "shadowImage2", "shadowImage3",
                                           "shadowImage4", "shadowImage5",  "shadowImage6", "shadowImage7",
                                           "shadowImage8", "shadowImage9", "shadowImage10", "shadowImage11"};
  for (uint32_t i = 0; i < PELLUCID_ENTRY_IMAGE_COUNT; ++i)
    all[PELLUCID_BINDING_SHADOW_IMAGES + i] = {PELLUCID_BINDING_SHADOW_IMAGES + i, kShadowImages[i], kSampled};
  return all;
}();

constexpr bool isComplete() {
  for (const Binding& binding : kBindings)
    if (binding.name == nullptr) return false;
  return true;
}
static_assert(isComplete());

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
