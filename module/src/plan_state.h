// The part of a plan that is the module's own.
#pragma once

#include <cstring>
#include <type_traits>

#include "frame_hash.h"
#include "pellucid/pellucid.h"
#include "reuse.h"

namespace pellucid {

struct PlanState {
  History history{};
  FrameHash frame{};  // of the frame that made the plan
};
static_assert(sizeof(PlanState) <= sizeof(PellucidPlanState) && std::is_trivially_copyable_v<PlanState>);

inline PlanState stateOf(const PellucidPlan& plan) {
  PlanState state;
  std::memcpy(static_cast<void*>(&state), plan.state.words, sizeof state);
  return state;
}

inline void keep(const PlanState& state, PellucidPlan* plan) {
  std::memcpy(plan->state.words, &state, sizeof state);
}

}  // namespace pellucid
