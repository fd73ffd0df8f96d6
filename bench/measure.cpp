#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include "bench_frame.h"

namespace pellucid::bench {

namespace {

constexpr double kSpan = 10000;  // microseconds of a command buffer
// Microseconds of a run, above which compilers and clocks are not what takes the time.
constexpr double kSlow = 100000;
using Clock = std::chrono::steady_clock;
Clock::time_point lastWork{};

// GPUs lower their clocks while images are being made, and take up to a second of work to raise them;
// software devices do not. `once`: what a run takes, microseconds.
template <class Run>
void warmUp(const harness::Device& device, double once, const Run& run) {
  if (once > kSlow || device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) return;
  const Clock::time_point start = Clock::now();
  const std::chrono::milliseconds least(start - lastWork > std::chrono::milliseconds(100) ? 1000 : 30);
  for (int i = 0; i < 2 || Clock::now() - start < least; ++i) run();
}

}  // namespace

Time percentiles(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.1), at(0.9)};
}

std::vector<Time> measureParts(harness::Device& device, int repeat, uint32_t parts,
                               const std::function<void(VkCommandBuffer, uint32_t)>& record) {
  // One part needs no timestamps between its passes. Recording single dispatches costs the host more than
  // whole frames.
  const int most = parts == 1 ? 256 : 8;
  // Microseconds of each part in one of `passes`.
  const auto run = [&](int passes) {
    const uint32_t parted = static_cast<uint32_t>(passes) * parts;
    const harness::Timestamps timestamps(device, parts == 1 ? 2 : parted + 1);
    uint32_t marks = 0;
    device.run([&](VkCommandBuffer commandBuffer) {
      timestamps.reset(commandBuffer);
      timestamps.mark(commandBuffer, marks++);
      for (uint32_t i = 0; i < parted; ++i) {
        record(commandBuffer, i % parts);
        if (i % parts + 1 == parts) computeBarrier(commandBuffer);
        if (parts > 1 || i + 1 == parted) timestamps.mark(commandBuffer, marks++);
      }
    });
    const std::vector<double> intervals = timestamps.intervals();
    std::vector<double> times(parts, 0);
    for (uint32_t i = 0; i < intervals.size(); ++i) times[i % parts] += intervals[i] / passes;
    return times;
  };
  const auto once = [&] {
    const std::vector<double> times = run(1);
    return std::accumulate(times.begin(), times.end(), 0.0);
  };
  double first = once();
  if (first < kSlow) first = once();  // the first use of a pipeline may compile it
  const int passes = static_cast<int>(std::clamp(std::ceil(kSpan / std::max(first, 1.0)), 1.0, 1.0 * most));
  warmUp(device, first, [&] { run(passes); });
  std::vector<std::vector<double>> times(parts);
  for (int i = 0; i < repeat; ++i) {
    const std::vector<double> each = run(passes);
    for (uint32_t k = 0; k < parts; ++k) times[k].push_back(each[k]);
  }
  lastWork = Clock::now();
  std::vector<Time> result;
  for (std::vector<double>& part : times) result.push_back(percentiles(std::move(part)));
  return result;
}

Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record) {
  return measureParts(device, repeat, 1,
                      [&](VkCommandBuffer commandBuffer, uint32_t) { record(commandBuffer); })
      .front();
}

}  // namespace pellucid::bench
