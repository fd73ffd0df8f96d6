// Dispatches that add light that comes through to every pixel.
#pragma once

#include "plan_builder.h"

namespace pellucid {

// The lights of a group: what was gathered of those that are gathered from, and one thickness a pixel of the
// others. Debug views are of this dispatch.
void addTranslucency(PlanBuilder& b, const LightGroup& group, uint32_t source, uint32_t destination);

// All lights of a group that thin walls let through, in a frame that gathers.
void addThinWalls(PlanBuilder& b, const LightGroup& group, uint32_t source, uint32_t destination);

// The light that an earlier dispatch or frame left in frame.history.
void addHistory(PlanBuilder& b, uint32_t source, uint32_t destination);

}  // namespace pellucid
