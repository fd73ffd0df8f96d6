#include "view/frame_times.h"

#include <algorithm>
#include <cstdio>

namespace pellucid::harness {

void MovingTimes::add(const FrameTime& time) {
  if (leftOut_ < kLeftOut)
    ++leftOut_;
  else
    times_.push_back(time);
}

FrameTime MovingTimes::mean() const {
  FrameTime sum;
  if (times_.empty()) return sum;
  for (const FrameTime& time : times_) {
    sum.frame += time.frame;
    sum.scene += time.scene;
    sum.rasterizer += time.rasterizer;
    sum.module += time.module;
  }
  const auto count = static_cast<double>(times_.size());
  return {sum.frame / count, sum.scene / count, sum.rasterizer / count, sum.module / count};
}

double MovingTimes::medianFrame() const {
  if (times_.empty()) return 0;
  std::vector<double> frames;
  for (const FrameTime& time : times_) frames.push_back(time.frame);
  std::sort(frames.begin(), frames.end());
  return (frames[(frames.size() - 1) / 2] + frames[frames.size() / 2]) / 2;
}

std::string MovingTimes::sentence() const {
  if (times_.empty()) return {};
  const FrameTime time = mean();
  char text[256];
  std::snprintf(text, sizeof text,
                "%zu moving frames: mean %.3f ms, median %.3f ms; of the mean, the scene takes %.3f ms; by the "
                "GPU's clock, the rasterizer takes %.3f ms and Pellucid %.3f ms",
                count(), time.frame, medianFrame(), time.scene, time.rasterizer, time.module);
  return text;
}

}  // namespace pellucid::harness
