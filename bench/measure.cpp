#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include "compute_pass.h"

namespace pellucid::bench {

namespace {

constexpr double kSpan = 10000;  // microseconds of a command buffer
// Microseconds of a run, above which compilers and clocks are not what takes the time.
constexpr double kSlow = 100000;
using Clock = std::chrono::steady_clock;
Clock::time_point lastWork{};

int passesFor(double microseconds, double most) {
  return static_cast<int>(std::clamp(std::ceil(kSpan / std::max(microseconds, 1.0)), 1.0, most));
}

// GPUs lower their clocks while images are being made, and take up to a second of work to raise them;
// software devices do not. `once`: what a run takes, microseconds.
template <class Run>
void warmUp(const harness::Device& device, double once, const Run& run) {
  if (once > kSlow || device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) return;
  const Clock::time_point start = Clock::now();
  const std::chrono::milliseconds least(start - lastWork > std::chrono::milliseconds(100) ? 1000 : 30);
  for (int i = 0; i < 2 || Clock::now() - start < least; ++i) run();
}

Time percentiles(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
  };
  return {at(0.5), at(0.1), at(0.9)};
}

}  // namespace

Time measure(harness::Device& device, int repeat, const std::function<void(VkCommandBuffer)>& record) {
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
  double once = run(1);
  if (once < kSlow) once = run(1);  // the first use of a pipeline may compile it
  const int passes = passesFor(once, 256);
  warmUp(device, once, [&] { run(passes); });
  std::vector<double> times;
  for (int i = 0; i < repeat; ++i) times.push_back(run(passes));
  lastWork = Clock::now();
  return percentiles(std::move(times));
}

std::vector<Time> measureParts(harness::Device& device, int repeat, uint32_t parts,
                               const std::function<void(VkCommandBuffer, uint32_t)>& record) {
  // Recording single dispatches costs the host more than whole frames.
  constexpr int kMost = 8;
  const harness::Timestamps timestamps(device, kMost * parts + 1);
  const auto run = [&](int times) {
    device.run([&](VkCommandBuffer commandBuffer) {
      timestamps.reset(commandBuffer);
      timestamps.mark(commandBuffer, 0);
      for (uint32_t i = 0; i < kMost * parts; ++i) {
        // All timestamps are read, so all are written.
        if (i < static_cast<uint32_t>(times) * parts) {
          record(commandBuffer, i % parts);
          if (i % parts + 1 == parts) computeBarrier(commandBuffer);
        }
        timestamps.mark(commandBuffer, i + 1);
      }
    });
    const std::vector<double> intervals = timestamps.intervals();
    std::vector<double> sums(parts, 0);
    for (uint32_t i = 0; i < static_cast<uint32_t>(times) * parts; ++i)
      sums[i % parts] += intervals[i] / times;
    return sums;
  };
  const std::vector<double> first = run(1);
  const double once = std::accumulate(first.begin(), first.end(), 0.0);
  const int passes = passesFor(once, kMost);
  warmUp(device, once, [&] { run(passes); });
  std::vector<std::vector<double>> times(parts);
  for (int i = 0; i < repeat; ++i) {
    const std::vector<double> sums = run(passes);
    for (uint32_t k = 0; k < parts; ++k) times[k].push_back(sums[k]);
  }
  lastWork = Clock::now();
  std::vector<Time> result;
  for (std::vector<double>& one : times) result.push_back(percentiles(std::move(one)));
  return result;
}

}  // namespace pellucid::bench
