// GPU times of repeated recordings.
#pragma once

#include <functional>
#include <vector>

#include "common/device.h"

namespace pellucid::bench {

struct Time {
  double median, low, high;  // microseconds; low and high: 10th and 90th percentile
};

// Runs `record` `repeat` times after `repeat / 5 + 2` that are not counted (clocks, caches), each in its
// own submission between two timestamps.
Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record);

}  // namespace pellucid::bench
