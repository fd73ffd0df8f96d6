// GPU times of repeated recordings.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/device.h"

namespace pellucid::bench {

// Of one recording.
struct Time {
  double median, low, high;  // microseconds; low and high: 10th and 90th percentile
};

Time percentiles(std::vector<double> times);

// Records `record` as often in one command buffer, with a compute barrier after each, as fills about ten
// milliseconds (at most 256 times), and divides: the gaps between submissions do not count, and are too short
// for the device to lower its clocks. `repeat` such command buffers are counted, after a second of some that
// are not where the device was idle before.
Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record);

// The same of each of `parts`, which are recorded in turn: what one costs where it stands, and nothing where
// the device finds that it need not run. A part brings its own barrier.
std::vector<Time> measureParts(harness::Device& device, int repeat, uint32_t parts,
                               const std::function<void(VkCommandBuffer, uint32_t part)>& record);

}  // namespace pellucid::bench
