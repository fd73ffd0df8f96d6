// The bandwidth floor: one pass over both depths, the irradiance and the output.
#pragma once

#include <string>

#include "common/gpu_image.h"
#include "measure.h"

namespace pellucid::bench {

struct Floor {
  Time time;          // of the fastest shape
  std::string shape;  // "16x16, 2 pixels a thread"
};

// The fastest of several workgroup shapes. Throws DeviceError when a pass wrote something else than its
// inputs say: a floor that skips work would be no floor.
Floor measureFloor(harness::Device& device, int width, int height, int repeat);

}  // namespace pellucid::bench
