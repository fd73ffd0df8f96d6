// Dispatches that make the tile lists.
#pragma once

#include "plan_builder.h"

namespace pellucid {

// Before all others.
void addTileLists(PlanBuilder& b);

}  // namespace pellucid
