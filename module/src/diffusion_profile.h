// A material's diffusion profile as the pyramid's passes read it.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// Octaves by which levels 4 and coarser take narrower Gaussians than their table, which was fitted to levels
// from 3 5 5 3 alone, says: they begin with averages of level 1, which are narrower.
constexpr double kCoarserShift = 0.03;

// All zeros (the pixel keeps everything) for a material without Gaussians. `fine`: the diffusion has its fine
// filter. `distances`: it sums edges by their distances. docs/diffusion.md has the fit.
shared::KernelConstants kernelConstants(const PellucidMaterial& material, bool fine, bool distances);

}  // namespace pellucid
