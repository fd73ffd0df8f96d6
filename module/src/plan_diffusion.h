// Dispatches of the diffusion's pyramid (docs/diffusion.md).
#pragma once

#include "plan_builder.h"

namespace pellucid {

// The base level, of 2 x 2 pixels of an image, which are copied on the way if `copy` is another one.
void addBaseLevel(PlanBuilder& b, uint32_t source, uint32_t copy);

// The two levels after `finer`.
void addDownsample(PlanBuilder& b, uint32_t finer);

// From the coarsest level down to level 2. Levels 6 and 7 are made on the way.
void addUpsample(PlanBuilder& b, uint32_t coarsest);

// To pixels. `addsProbes`: the gather's filtered probes are added.
void addDiffuse(PlanBuilder& b, uint32_t source, uint32_t destination, bool addsProbes);

}  // namespace pellucid
