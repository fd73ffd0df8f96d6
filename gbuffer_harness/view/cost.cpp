#include "view/cost.h"

#include <algorithm>
#include <map>

namespace pellucid::harness {

namespace {

constexpr double kNewShare = 0.109;  // 1 - 2^(-1/6)
constexpr double kForgotten = 0.01;  // microseconds, of a dispatch that frames no longer have

}  // namespace

double sumOf(const std::vector<DispatchTime>& times) {
  double sum = 0;
  for (const DispatchTime& time : times) sum += time.microseconds;
  return sum;
}

void CostHistory::add(std::uint64_t frame, const std::vector<DispatchTime>& times) {
  if (frame == last_) return;
  last_ = frame;
  std::map<std::string, double> now;
  for (const DispatchTime& time : times) {
    now[time.name] += time.microseconds;
    if (std::none_of(dispatches_.begin(), dispatches_.end(),
                     [&](const Dispatch& d) { return d.name == time.name; }))
      dispatches_.push_back({time.name, time.microseconds});
  }
  for (Dispatch& dispatch : dispatches_)
    dispatch.smoothed += kNewShare * (now[dispatch.name] - dispatch.smoothed);
  std::erase_if(dispatches_, [](const Dispatch& d) { return d.smoothed < kForgotten; });
}

double CostHistory::smoothedSum() const {
  double sum = 0;
  for (const Dispatch& dispatch : dispatches_) sum += dispatch.smoothed;
  return sum;
}

}  // namespace pellucid::harness
