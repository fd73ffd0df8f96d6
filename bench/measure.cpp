#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "compute_pass.h"

namespace pellucid::bench {

Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record) {
  constexpr double kSpan = 10000;  // microseconds
  constexpr double kMost = 256;
  const harness::Timestamps timestamps(device, 2);
  const auto run = [&](int times) {
    device.run([&](VkCommandBuffer commandBuffer) {
      timestamps.reset(commandBuffer);
      timestamps.mark(commandBuffer, 0);
      for (int i = 0; i < times; ++i) {
        record(commandBuffer);
        computeBarrier(commandBuffer);
      }
      timestamps.mark(commandBuffer, 1);
    });
    return timestamps.intervals()[0] / times;
  };
  run(1);  // the first use of a pipeline may compile it
  const double once = run(1);
  const int passes = static_cast<int>(std::clamp(std::ceil(kSpan / std::max(once, 1.0)), 1.0, kMost));
  std::vector<double> times;
  // Devices lower their clocks while images are being made, and take up to a second of work to raise them.
  using Clock = std::chrono::steady_clock;
  static Clock::time_point lastWork{};
  const Clock::time_point start = Clock::now();
  const std::chrono::milliseconds warmUp(start - lastWork > std::chrono::milliseconds(100) ? 1000 : 30);
  for (int i = 0; i < 2 || Clock::now() - start < warmUp; ++i) run(passes);
  for (int i = 0; i < repeat; ++i) times.push_back(run(passes));
  lastWork = Clock::now();
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.1), at(0.9)};
}

}  // namespace pellucid::bench
