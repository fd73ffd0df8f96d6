// A material's constants for the light-space gather (docs/how-it-works.md). Pure.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// True for transmittance models that the gather's kernel follows from.
inline bool canBeGathered(uint32_t transmittanceModel) {
  return transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2 ||
         transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP;
}

// Of a material of such a model.
shared::GatherConstants gatherConstants(const PellucidMaterial& material);

// How far from a surface its probes look for entry points, mm.
float gatherReach(const shared::GatherConstants& gather, uint32_t samples);

}  // namespace pellucid
