// A material's constants for the light-space gather (docs/gather.md). Pure.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// Of a material whose transmittance is EXP2 or SINH_EXP.
shared::GatherConstants gatherConstants(const PellucidMaterial& material);

}  // namespace pellucid
