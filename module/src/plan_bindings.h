// What dispatches of a plan bind, as it is packed: a slot for each binding of the pass but shadow images,
// which lie in plan.shadowImages. A slot is an image's resource, or an offset in the constants in steps of
// 256 bytes.
#pragma once

#include <array>
#include <bit>

#include "pass.h"

namespace pellucid {

inline constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
inline constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
inline constexpr VkDeviceSize kSlotBytes = 256;

// Slot of a binding that the pass has and that is no shadow image.
constexpr uint32_t slotOf(const Pass& pass, uint32_t binding) {
  return static_cast<uint32_t>(std::popcount(pass.bindings() & ((BindingSet{1} << binding) - 1)));
}

struct BoundList {
  uint32_t count = 0;
  std::array<PellucidBinding, PELLUCID_MAX_BINDINGS> list;

  const PellucidBinding* begin() const { return list.data(); }
  const PellucidBinding* end() const { return list.data() + count; }
};

// `dispatch`: of the plan, or a copy.
BoundList boundBy(const PellucidPlan& plan, const PellucidDispatch& dispatch);

}  // namespace pellucid
