#pragma once

#include <string>

#include "pellucid/pellucid.h"

namespace pellucid::harness {

std::string planJson(const PellucidPlan& plan);

}  // namespace pellucid::harness
