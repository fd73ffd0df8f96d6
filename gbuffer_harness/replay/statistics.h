// The decisions of the device in a finished frame: workgroups that ran, and blocks with material.
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::harness {

// Workgroups of one or several dispatches. `most`: all that can run, and all that do where the device does not decide.
struct Groups {
  std::uint64_t run = 0, most = 0;
};

struct Statistics {
  std::vector<Groups> dispatches;  // in the plan's order
  Groups blocks;                   // with material, of those that can have some; 0 if nothing diffuses or is gathered
  Groups entryPoints, probes;      // groups of them; 0 without a gather
  bool lists = false;              // the device listed the blocks with material
};

// `constants`: the slice of the plan's last recording, which is finished.
Statistics readStatistics(const PellucidPlan& plan, const void* constants);

}  // namespace pellucid::harness
