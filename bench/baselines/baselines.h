// Published screen-space diffusions, for the module's to be compared with: own implementations, each with the
// kernel that its paper derives for the frame's material.
#pragma once

#include <memory>
#include <vector>

#include "bench_frame.h"

namespace pellucid::bench {

// d'Eon & Luebke 2007 / Jimenez et al. 2009: six Gaussians, two passes each.
Variant gaussianSum(const std::shared_ptr<const BenchFrame>& frame);

// Jimenez et al. 2015, pre-integrated kernel: `taps` an axis, odd.
Variant separable(const std::shared_ptr<const BenchFrame>& frame, int taps);

// Golubev 2018: one pass of `samples` texels.
Variant burleyDisk(const std::shared_ptr<const BenchFrame>& frame, int samples);

// All of them, in the sizes that are in use.
std::vector<Variant> baselines(const std::shared_ptr<const BenchFrame>& frame);

}  // namespace pellucid::bench
