// A material's constants for the light-space gather (docs/how-it-works.md). Pure.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// Of a material whose model canBeGathered.
shared::GatherConstants gatherConstants(const PellucidMaterial& material);

// How far from a surface its probes look for entry points, mm.
float gatherReach(const shared::GatherConstants& gather, uint32_t samples);

}  // namespace pellucid
