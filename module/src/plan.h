#pragma once

#include "frame.h"
#include "reuse.h"

namespace pellucid {

// The frame's plan after one that left `kept`. PELLUCID_ERROR_CAPACITY, and no dispatches, where they are
// more than a plan holds.
PellucidResult buildPlan(const FrameFacts& facts, const History& kept, PellucidPlan* plan);

}  // namespace pellucid
