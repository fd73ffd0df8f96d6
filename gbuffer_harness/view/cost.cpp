#include "view/cost.h"

#include <algorithm>

namespace pellucid::harness {

namespace {

constexpr double kNewShare = 0.109;  // 1 - 2^(-1/6)

}  // namespace

double sumOf(const std::vector<DispatchTime>& times) {
  double sum = 0;
  for (const DispatchTime& time : times) sum += time.microseconds;
  return sum;
}

bool CostHistory::add(std::uint64_t frame, const std::vector<DispatchTime>& times) {
  if (frame == last_) return false;
  last_ = frame;
  const bool first = frames_ == 0;
  frames_ = std::min(frames_ + 1, kFrames);
  for (Dispatch& dispatch : dispatches_) dispatch.history.push_back(0);
  for (const DispatchTime& time : times) {
    const auto found = std::find_if(dispatches_.begin(), dispatches_.end(),
                                    [&](const Dispatch& d) { return d.name == time.name; });
    const bool isNew = found == dispatches_.end();
    Dispatch& dispatch = isNew ? dispatches_.emplace_back() : *found;
    if (isNew) {
      dispatch.name = time.name;
      dispatch.history.assign(frames_, 0);
      if (!first) dispatch.smoothed = time.microseconds;
    }
    dispatch.history.back() += time.microseconds;
  }
  for (Dispatch& dispatch : dispatches_) {
    if (dispatch.history.size() > kFrames) dispatch.history.pop_front();
    const double now = dispatch.history.back();
    dispatch.smoothed = first ? now : dispatch.smoothed + kNewShare * (now - dispatch.smoothed);
  }
  // A dispatch that has not run for the whole history is forgotten.
  std::erase_if(dispatches_, [](const Dispatch& d) {
    return std::all_of(d.history.begin(), d.history.end(), [](double t) { return t == 0; });
  });
  return true;
}

double CostHistory::smoothedSum() const {
  double sum = 0;
  for (const Dispatch& dispatch : dispatches_) sum += dispatch.smoothed;
  return sum;
}

double CostHistory::lastSum() const {
  double sum = 0;
  for (const Dispatch& dispatch : dispatches_) sum += dispatch.history.back();
  return sum;
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
