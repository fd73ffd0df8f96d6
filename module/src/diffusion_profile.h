// A material's diffusion profile as the pyramid's passes read it.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// All zeros (the pixel keeps everything) for a material without Gaussians. `fine`: the diffusion has its fine
// filter. docs/diffusion.md has the fit.
shared::KernelConstants kernelConstants(const PellucidMaterial& material, bool fine);

}  // namespace pellucid
