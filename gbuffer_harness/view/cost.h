// The time of each dispatch of recent frames, and the budget that holds a frame time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace pellucid::harness {

double sumOf(const std::vector<DispatchTime>& times);  // microseconds

class CostHistory {
public:
  // GPU times of one frame; `frame` counts recordings. False: that one was added before, and is not again.
  bool add(std::uint64_t frame, const std::vector<DispatchTime>& times);

  struct Dispatch {
    std::string name;     // dispatches of one name in a frame add up
    double smoothed = 0;  // microseconds; half of it is of the last 6 frames
    double last = 0;
  };
  const std::vector<Dispatch>& dispatches() const { return dispatches_; }
  double smoothedSum() const;  // microseconds
  double lastSum() const;

private:
  std::vector<Dispatch> dispatches_;
  std::uint64_t last_ = 0;
};

// A setting that holds a frame time (Whelan 2009, 6.2.5), and what it was decided from.
struct BudgetState {
  std::uint32_t gatherSamples = 16;               // 16 best, 8, 4, 0 cheapest
  std::uint32_t reuse = 0;                        // 1: reuse; given up last when there is room again
  std::uint32_t overFrames = 0, underFrames = 0;  // on end above the budget; on end with room for more
  std::uint32_t settleFrames = 0;                 // times of the setting before that may still arrive
  std::uint32_t waitFrames = 30;                  // of room before a better setting is tried
  std::uint32_t raised = 0, heldFrames = 0;       // 1: the last change was upwards; frames since
  float raisedMs = 0;              // time before the last step upwards; 0: no step to compare with
  std::uint32_t easierFrames = 0;  // on end well below raisedMs after that step failed
};

// One frame's time, ms, against the budget. Goes one setting down (reuse first, then samples) after 3 frames
// on end above the budget, so a setting that fits is reached within 20 frames; one up after waitFrames at
// most 70 % of it. An upward step that does not hold doubles the wait, until 30 frames on end take 70 % of
// the time from before it. Times that are negative or not finite, and budgets that are not > 0, change
// nothing.
void stepBudget(BudgetState& state, float measuredMs, float budgetMs);

struct Budget {
  bool on = false;
  float milliseconds = 2;
  BudgetState state;

  // After one frame of that time: true where the samples or the reuse changed.
  bool step(double frameMilliseconds, ReplaySettings& settings);
};

}  // namespace pellucid::harness
