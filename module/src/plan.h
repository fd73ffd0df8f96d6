#pragma once

#include "frame.h"
#include "reuse.h"

namespace pellucid {

// The frame's plan after one that left `kept`. PELLUCID_ERROR_CAPACITY, and no dispatches, where they are
// more than a plan holds.
PellucidResult buildPlan(const FrameFacts& facts, const History& kept, PellucidPlan* plan);

// Adds the dispatches of the frame to a plan without any; `reused`: an earlier frame's light stands in for
// this frame's. False: they are more than a plan holds.
bool addPasses(const FrameFacts& facts, bool reused, PellucidPlan* plan);

}  // namespace pellucid
