// The part of a plan that is the module's own.
#pragma once

#include <cstring>
#include <type_traits>

#include "pellucid/pellucid.h"
#include "rect.h"
#include "reuse.h"

namespace pellucid {

struct PlanState {
  History history{};
  // Facts of the frame that made the plan:
  uint32_t materials = 0;
  Rect rect{};
  VkFormat outputFormat = VK_FORMAT_UNDEFINED;
  uint32_t lightTables = 0;
  uint32_t options = 0;                  // PellucidUse bits that pipelines must look for
  uint32_t layeredMap = 0, layer = 0;  // the first map in a layer above 0, plus 1; 0: none
};
static_assert(sizeof(PlanState) <= sizeof(PellucidPlan::state) && std::is_trivially_copyable_v<PlanState>);

inline PlanState stateOf(const PellucidPlan& plan) {
  PlanState state;
  std::memcpy(static_cast<void*>(&state), plan.state, sizeof state);
  return state;
}

inline void keep(const PlanState& state, PellucidPlan* plan) {
  std::memcpy(plan->state, &state, sizeof state);
}

}  // namespace pellucid
