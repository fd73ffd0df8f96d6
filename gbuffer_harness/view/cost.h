// The time of each dispatch of recent frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace pellucid::harness {

double sumOf(const std::vector<DispatchTime>& times);  // microseconds

class CostHistory {
public:
  // GPU times of one frame; `frame` counts recordings. One that was added before is not again.
  void add(std::uint64_t frame, const std::vector<DispatchTime>& times);

  struct Dispatch {
    std::string name;     // dispatches of one name in a frame add up
    double smoothed = 0;  // microseconds; half of it is of the last 6 frames
  };
  const std::vector<Dispatch>& dispatches() const { return dispatches_; }
  double smoothedSum() const;  // microseconds

private:
  std::vector<Dispatch> dispatches_;
  std::uint64_t last_ = 0;
};

}  // namespace pellucid::harness
