// How far the gather's samples are from the sum over all texels of the shadow map.
#pragma once

#include <cstdint>
#include <vector>

#include "diffusions.h"

namespace pellucid::bench {

// For each number of samples, translucency alone on an ear against the float64 reference: relative RMSE of
// 4x4 averages, worst channel.
std::vector<double> gatherErrors(const Site& site, const std::vector<uint32_t>& samples);

}  // namespace pellucid::bench
