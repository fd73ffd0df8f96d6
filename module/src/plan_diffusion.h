// The dispatches of the diffusion. docs/how-it-works.md says what each of them does.
#pragma once

#include "plan_builder.h"

namespace pellucid {

// `copy`: where pixels go that the last dispatch reads; `source` itself: nowhere.
void addBaseLevel(PlanBuilder& b, uint32_t source, uint32_t copy);
void addListBlocks(PlanBuilder& b);
void addDownsample(PlanBuilder& b, uint32_t finer);
void addUpsample(PlanBuilder& b, uint32_t coarsest);
// With the light of the probes, if the frame has some.
void addDiffuse(PlanBuilder& b, uint32_t source, uint32_t destination);

}  // namespace pellucid
