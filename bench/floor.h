// The bandwidth floor: one pass over both depths, the irradiance and the output.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/gpu_image.h"
#include "measure.h"

namespace pellucid::bench {

struct Floor {
  Time time;
  std::string shape;  // "16x16, 2 pixels a thread"
};

// Over the depths and the irradiance of a capture, as a device may read constants faster than what a frame
// reads. Of several workgroup shapes, the fastest, which all ratios are to, first. Throws DeviceError when a
// pass wrote something else than its inputs say: a floor that skips work would be no floor.
std::vector<Floor> measureFloors(harness::Device& device, const harness::Capture& capture, int repeat);

}  // namespace pellucid::bench
