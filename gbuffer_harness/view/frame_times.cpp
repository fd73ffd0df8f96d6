#include "view/frame_times.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

namespace pellucid::harness {

void MovingTimes::add(const FrameTime& time) {
  if (leftOut_ < kLeftOut)
    ++leftOut_;
  else
    times_.push_back(time);
}

MovingTimes::Summary MovingTimes::of(double FrameTime::*part) const {
  std::vector<double> values;
  for (const FrameTime& time : times_) values.push_back(time.*part);
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  return {std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(count),
          (values[(count - 1) / 2] + values[count / 2]) / 2, values.front()};
}

std::string MovingTimes::table() const {
  if (times_.empty()) return {};
  const std::pair<const char*, double FrameTime::*> parts[] = {
      {"whole frame", &FrameTime::frame},
      {"scene", &FrameTime::scene},
      {"rasterizer, GPU's clock", &FrameTime::rasterizer},
      {"Pellucid, GPU's clock", &FrameTime::module}};
  char line[128];
  std::snprintf(line, sizeof line, "%-26s%10s%10s%10s\n",
                (std::to_string(count()) + " moving frames, ms").c_str(), "mean", "median", "best");
  std::string text = line;
  for (const auto& [name, part] : parts) {
    const Summary summary = of(part);
    std::snprintf(line, sizeof line, "%-26s%10.3f%10.3f%10.3f\n", name, summary.mean, summary.median,
                  summary.best);
    text += line;
  }
  return text;
}

}  // namespace pellucid::harness
