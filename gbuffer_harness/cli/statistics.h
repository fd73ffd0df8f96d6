#pragma once

#include <string>

#include "pellucid/pellucid_statistics.h"

namespace pellucid::harness {

// Tables for a person: groups of each dispatch, and totals of the frame. `statistics`: of the plan.
std::string statisticsText(const PellucidPlan& plan, const PellucidStatistics& statistics);

}  // namespace pellucid::harness
