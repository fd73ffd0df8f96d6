#include "view/cost.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace pellucid::harness {

namespace {

constexpr double kNewShare = 0.109;  // 1 - 2^(-1/6)
constexpr double kForgotten = 0.01;  // microseconds, of a dispatch that frames no longer have

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

double sumOf(const std::vector<DispatchTime>& times) {
  double sum = 0;
  for (const DispatchTime& time : times) sum += time.microseconds;
  return sum;
}

bool CostHistory::add(std::uint64_t frame, const std::vector<DispatchTime>& times) {
  if (frame == last_) return false;
  last_ = frame;
  std::map<std::string, double> now;
  for (const DispatchTime& time : times) {
    now[time.name] += time.microseconds;
    if (std::none_of(dispatches_.begin(), dispatches_.end(), [&](const Dispatch& d) { return d.name == time.name; }))
      dispatches_.push_back({time.name, time.microseconds, 0});
  }
  for (Dispatch& dispatch : dispatches_) {
    dispatch.last = now[dispatch.name];
    dispatch.smoothed += kNewShare * (dispatch.last - dispatch.smoothed);
  }
  std::erase_if(dispatches_, [](const Dispatch& d) { return d.smoothed < kForgotten; });
  return true;
}

double CostHistory::smoothedSum() const {
  double sum = 0;
  for (const Dispatch& dispatch : dispatches_) sum += dispatch.smoothed;
  return sum;
}

double CostHistory::lastSum() const {
  double sum = 0;
  for (const Dispatch& dispatch : dispatches_) sum += dispatch.last;
  return sum;
}

void stepBudget(BudgetState& s, float measuredMs, float budgetMs) {
  if (!(budgetMs > 0) || !(measuredMs >= 0) || !std::isfinite(measuredMs)) return;
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

bool Budget::step(double frameMilliseconds, ReplaySettings& settings) {
  if (!on) return false;
  stepBudget(state, static_cast<float>(frameMilliseconds), milliseconds);
  const PellucidReuse reuse = state.reuse ? PELLUCID_REUSE_COHERENCE : PELLUCID_REUSE_NONE;
  std::uint32_t& samples = settings.translucency.gatherSamples;
  const bool changed = samples != state.gatherSamples || settings.reuse != reuse;
  samples = state.gatherSamples;
  settings.reuse = reuse;
  return changed;
}

}  // namespace pellucid::harness
