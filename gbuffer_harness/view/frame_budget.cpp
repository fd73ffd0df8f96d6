// Holds a frame time. Whelan 2009, 6.2.5.
#include "view/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pellucid::harness {
namespace {

constexpr std::uint32_t kSamples[] = {0, 4, 8, 16};  // of a probe, from the cheapest on
constexpr std::uint32_t kBest = kSamples[3];
constexpr std::uint32_t kOverFrames = 3;    // a single spike changes nothing
constexpr std::uint32_t kSettleFrames = 2;  // GPU times arrive a frame or two late
constexpr std::uint32_t kFirstWait = 30;    // frames of room before a better setting is tried
constexpr std::uint32_t kLongestWait = 4096;
constexpr float kRoom = 0.7f;  // of the budget; the next setting may cost as much again as it frees

bool best(const BudgetState& s) { return s.gatherSamples == kBest && s.reuse == 0; }
bool cheapest(const BudgetState& s) { return s.gatherSamples == 0; }

void changed(BudgetState& s) {
  s.overFrames = s.underFrames = s.easierFrames = 0;
  s.settleFrames = kSettleFrames;
}

// A damaged state goes on from the nearest valid one.
void mend(BudgetState& s) {
  s.gatherSamples = *std::find_if(std::begin(kSamples), std::end(kSamples) - 1,
                                  [&](std::uint32_t samples) { return samples >= s.gatherSamples; });
  s.reuse = std::min(s.reuse, 1u);
  s.settleFrames = std::min(s.settleFrames, kSettleFrames);
  s.overFrames = std::min(s.overFrames, kOverFrames);
  s.waitFrames = std::clamp(s.waitFrames, kFirstWait, kLongestWait);
  s.underFrames = std::min(s.underFrames, kLongestWait);
  s.easierFrames = std::min(s.easierFrames, kFirstWait);
  s.heldFrames = std::min(s.heldFrames, 4 * kLongestWait);
  if (!(s.raisedMs >= 0) || !std::isfinite(s.raisedMs)) s.raisedMs = 0;
}

// Reuse goes first: it costs a lag in the light, fewer samples cost dots.
void lower(BudgetState& s) {
  if (s.reuse == 0)
    s.reuse = 1;
  else
    s.gatherSamples = *(std::find(std::begin(kSamples), std::end(kSamples), s.gatherSamples) - 1);
  changed(s);
}

void raise(BudgetState& s) {
  if (s.gatherSamples < kBest)
    s.gatherSamples = *(std::find(std::begin(kSamples), std::end(kSamples), s.gatherSamples) + 1);
  else
    s.reuse = 0;
  changed(s);
}

}  // namespace

void stepBudget(BudgetState& s, float measuredMs, float budgetMs) {
  if (!(budgetMs > 0) || !(measuredMs >= 0) || !std::isfinite(measuredMs)) return;
  mend(s);
  if (s.settleFrames > 0) {
    --s.settleFrames;
    return;
  }
  // A raise proves itself by lasting well beyond the wait that led to it.
  if (s.raised != 0 && ++s.heldFrames > 4 * s.waitFrames) {
    s.raised = 0;
    s.waitFrames = std::max(s.waitFrames / 2, kFirstWait);
  }
  s.overFrames = measuredMs > budgetMs ? s.overFrames + 1 : 0;
  s.underFrames = measuredMs <= kRoom * budgetMs ? std::min(s.underFrames + 1, kLongestWait) : 0;
  // Much less than when a raise failed: the load is another one, and what it taught no longer holds.
  const bool easier = s.raised == 0 && measuredMs <= kRoom * s.raisedMs;
  s.easierFrames = easier ? s.easierFrames + 1 : 0;
  if (s.easierFrames >= kFirstWait) {
    s.waitFrames = kFirstWait;
    s.raisedMs = 0;
    s.easierFrames = 0;
  }
  if (s.overFrames >= kOverFrames && !cheapest(s)) {
    // It did not fit: the next try waits twice as long, so a load between two settings cannot swing.
    if (s.raised != 0)
      s.waitFrames = std::min(2 * s.waitFrames, kLongestWait);
    else
      s.raisedMs = 0;
    s.raised = 0;
    lower(s);
  } else if (s.underFrames >= s.waitFrames && !best(s)) {
    raise(s);
    s.raised = 1;
    s.raisedMs = measuredMs;
    s.heldFrames = 0;
  }
  s.overFrames = std::min(s.overFrames, kOverFrames);
}

}  // namespace pellucid::harness
