// Published screen-space diffusions, for the module's to be compared with: own implementations, each with the
// kernel that its paper derives for the frame's material.
#pragma once

#include <memory>
#include <vector>

#include "bench_frame.h"

namespace pellucid::bench {

// The image to diffuse: the frame's irradiance, or an image of rgba16f in its place.
using Source = std::shared_ptr<const harness::GpuImage>;

// d'Eon & Luebke 2007 / Jimenez et al. 2009: six Gaussians, two passes each.
Variant gaussianSum(const std::shared_ptr<const BenchFrame>& frame, const Source& source = nullptr);

// Jimenez et al. 2015, pre-integrated kernel: `taps` an axis, odd.
Variant separable(const std::shared_ptr<const BenchFrame>& frame, int taps, const Source& source = nullptr);

// Golubev 2018: one pass of `samples` texels.
Variant burleyDisk(const std::shared_ptr<const BenchFrame>& frame, int samples,
                   const Source& source = nullptr);

// All of them, in the sizes that are in use.
std::vector<Variant> baselines(const std::shared_ptr<const BenchFrame>& frame);
inline constexpr int kSeparableTaps[] = {11, 17, 25}, kBurleySamples[] = {20, 40, 80};

}  // namespace pellucid::bench
