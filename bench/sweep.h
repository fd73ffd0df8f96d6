// Time against error of the diffusions over image sizes and radii.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "diffusions.h"
#include "options.h"

namespace pellucid::bench {

// Prints one row for each radius and diffusion: the error, which does not depend on the size, and the time at
// each size with its multiple of that size's floor. Returns an object for each of these times and sets a plot
// for each size. Baselines slower than kSlowest floors at the last size are named and left out.
inline constexpr double kSlowest = 90;  // 6 ms at 3840 x 2160 on an NVIDIA H100
nlohmann::json sweep(const Site& site, const SweepOptions& options, int repeat, std::FILE* table,
                     std::vector<harness::Plot>* plots);

}  // namespace pellucid::bench
