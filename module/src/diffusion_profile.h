// A material's diffusion profile as the pyramid's passes read it.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// All zeros (the pixel keeps everything) for a material without Gaussians.
shared::KernelConstants kernelConstants(const PellucidMaterial& material);

}  // namespace pellucid
