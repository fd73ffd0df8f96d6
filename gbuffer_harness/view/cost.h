// Cost of the module's dispatches over the last frames, and the budget that holds this cost.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "replay/replay.h"
#include "view/frame_budget.h"
#include "view/state.h"

namespace pellucid::harness {

double sumOf(const std::vector<DispatchTime>& times);  // microseconds

class CostHistory {
public:
  // GPU times of one frame; `frame` counts recordings. False: that one was added before, and is not again.
  bool add(std::uint64_t frame, const std::vector<DispatchTime>& times);

  struct Dispatch {
    std::string name;            // dispatches of one name in a frame add up
    double smoothed = 0;         // microseconds; half of it is of the last 6 frames
    std::deque<double> history;  // of each frame, the newest last, at most kFrames; 0 where it did not run
  };
  static constexpr std::size_t kFrames = 160;
  const std::vector<Dispatch>& dispatches() const { return dispatches_; }
  double smoothedSum() const;  // microseconds
  double lastSum() const;
  std::size_t size() const { return frames_; }  // of the histories

private:
  std::vector<Dispatch> dispatches_;
  std::size_t frames_ = 0;
  std::uint64_t last_ = 0;
};

// Whelan 2009, 6.2.5, by stepBudget.
struct Budget {
  bool on = false;
  float milliseconds = 2;
  BudgetState state;

  // After one frame of that time: true where the samples or the reuse changed.
  bool step(double frameMilliseconds, ReplaySettings& settings);
};

}  // namespace pellucid::harness
