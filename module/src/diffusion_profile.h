// A material's diffusion profile as the pyramid's passes read it.
#pragma once

#include "pellucid/pellucid.h"
#include "pyramid_energy.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// All zeros (the pixel keeps everything) for a material without Gaussians. `distances`: with what sums over
// distances in space take.
shared::KernelConstants kernelConstants(const PellucidMaterial& material, FineFilters filters,
                                        bool distances);

}  // namespace pellucid
