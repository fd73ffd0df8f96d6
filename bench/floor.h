// The bandwidth floor: one pass over both depths, the irradiance and the output.
#pragma once

#include <string>
#include <vector>

#include "common/gpu_image.h"
#include "measure.h"

namespace pellucid::bench {

struct Floor {
  Time time;
  std::string shape;  // "16x16, 2 pixels a thread"
};

// Of several workgroup shapes, the fastest, which all ratios are to, first. Throws DeviceError when a pass wrote
// something else than its inputs say: a floor that skips work would be no floor.
std::vector<Floor> measureFloors(harness::Device& device, int width, int height, int repeat);

}  // namespace pellucid::bench
