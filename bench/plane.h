// Sections on planes and patterns.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "diffusions.h"
#include "options.h"
#include "report.h"

namespace pellucid::bench {

inline constexpr const char* kPlaneTables[] = {"module", "fused", "gather", "diffusion"};

struct PlanePlots {
  double floor;  // microseconds
  std::vector<harness::Plot> diffusion;
};

// Adds the rows of `tables` to `report`, after those of the floor, which becomes the report's.
PlanePlots measurePlanes(const Site& site, const std::set<std::string>& tables, const PlaneOptions& options,
                         int repeat, Report& report);

}  // namespace pellucid::bench
