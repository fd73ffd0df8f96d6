#include "plan_bindings.h"

#include <algorithm>

#include "constants_layout.h"
#include "plan_state.h"

namespace pellucid {
namespace {

// Bytes that passes see of the constants from a binding's offset on.
VkDeviceSize windowOf(const PellucidPlan& plan, const PlanState& state, uint32_t binding,
                      VkDeviceSize offset) {
  switch (binding) {
    case PELLUCID_BINDING_FRAME:
      return sizeof(shared::FrameConstants);
    case PELLUCID_BINDING_LIGHTS:
      return kLightWindow;
    case PELLUCID_BINDING_SHADOWS:
      return kShadowWindow;
    case PELLUCID_BINDING_GATHER_MAPS:
      return kGatherMapWindow;
    case PELLUCID_BINDING_ENTRY_MAPS:
      return kEntryMapWindow;
    case PELLUCID_BINDING_MATERIALS:
      return state.materials * sizeof(shared::MaterialConstants);
    case PELLUCID_BINDING_KERNELS:
      return state.materials * sizeof(shared::KernelConstants);
    default:  // lists, which are the last of the slice
      return plan.constantsSize - offset;
  }
}

}  // namespace

BoundList boundBy(const PellucidPlan& plan, const PellucidDispatch& d) {
  BoundList bound;
  if (d.pipeline >= allPasses().size()) return bound;
  const PlanState state = stateOf(plan);
  const uint32_t first = std::min<uint32_t>(d.firstShadowImage, PELLUCID_PLAN_SHADOW_IMAGES);
  const uint32_t imageCount = std::min<uint32_t>(d.shadowImageCount, PELLUCID_PLAN_SHADOW_IMAGES - first);
  uint32_t slot = 0;
  forEach(allPasses()[d.pipeline]->bindings(), [&](const Binding& b) {
    PellucidBinding& to = bound.list[bound.count++];
    to = {b.number, b.type, PELLUCID_RESOURCE_FRONT_DEPTH, 0, 0};
    if (b.number >= PELLUCID_BINDING_SHADOW_IMAGES) {
      // Slots that are not read hold a view of the type that shadow images have, as far as the frame has one.
      const uint32_t image = b.number - PELLUCID_BINDING_SHADOW_IMAGES;
      if (imageCount > 0)
        to.resource = kShadow0 + plan.shadowImages[first + (image < imageCount ? image : 0)];
    } else if (b.type == kUniforms || b.type == kStorage) {
      to.resource = PELLUCID_RESOURCE_CONSTANTS;
      to.offset = d.slots[slot++] * kSlotBytes;
      to.size = windowOf(plan, state, b.number, to.offset);
    } else {
      to.resource = d.slots[slot++];
    }
  });
  return bound;
}

}  // namespace pellucid

extern "C" uint32_t pellucidGetBindings(const PellucidPlan* plan, uint32_t dispatch,
                                        PellucidBinding* bindings) {
  if (!plan || !bindings || dispatch >= plan->dispatchCount || dispatch >= PELLUCID_MAX_DISPATCHES) return 0;
  const pellucid::BoundList bound = pellucid::boundBy(*plan, plan->dispatches[dispatch]);
  std::copy(bound.begin(), bound.end(), bindings);
  return bound.count;
}
