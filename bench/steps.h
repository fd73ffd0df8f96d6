// Translucency of camera-space thickness as separate dispatches, the way Whelan 2009 (4.7.2) first has it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bench_frame.h"

namespace pellucid::bench {

// Linearize front and back depth, thickness, transmittance, addition; the same with thickness and
// transmittance in one; and the module's one dispatch. The frame: device depths, normals, back depth, at most
// one shadow image, translucency alone with 1.
std::vector<Variant> translucencyVariants(const std::shared_ptr<const BenchFrame>& frame);

// The steps of the first two one by one, without the linearization, which a raster pass of planar distances
// does: thickness; transmittance of it; thickness and transmittance in one; addition. They have run once.
struct TranslucencySteps {
  std::function<void(VkCommandBuffer)> thickness, transmittance, both, addition;
};
TranslucencySteps translucencySteps(const std::shared_ptr<const BenchFrame>& frame);

}  // namespace pellucid::bench
