#pragma once

#include <string>

#include "pellucid/pellucid.h"

namespace pellucid::harness {

// A plan as JSON. `indent`: spaces of each level; -1: all in one line.
std::string planJson(const PellucidPlan& plan, int indent = -1);

}  // namespace pellucid::harness
