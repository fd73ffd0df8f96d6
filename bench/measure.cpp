#include "measure.h"

#include <algorithm>

namespace pellucid::bench {

Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record) {
  std::vector<double> times;
  const harness::Timestamps timestamps(device, 2);
  const int warmUp = repeat / 5 + 2;
  for (int i = 0; i < warmUp + repeat; ++i) {
    device.run([&](VkCommandBuffer commandBuffer) {
      timestamps.reset(commandBuffer);
      timestamps.mark(commandBuffer, 0);
      record(commandBuffer);
      timestamps.mark(commandBuffer, 1);
    });
    if (i >= warmUp) times.push_back(timestamps.intervals()[0]);
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.1), at(0.9)};
}

}  // namespace pellucid::bench
