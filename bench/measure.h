// GPU times of repeated recordings.
#pragma once

#include <functional>

#include "common/device.h"

namespace pellucid::bench {

// Of one recording.
struct Time {
  double median, low, high;  // microseconds; low and high: 10th and 90th percentile
};

// Records `record` as often in one command buffer, with a compute barrier after each, as fills about ten
// milliseconds (at most 256 times), and divides: the gaps between submissions do not count, and are too short for
// the device to lower its clocks. `repeat` such command buffers are counted, after a second of some that are not
// where the device was idle before.
Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record);

}  // namespace pellucid::bench
