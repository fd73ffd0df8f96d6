// Times of the frames in which the scene moves.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid::harness {

// Milliseconds.
struct FrameTime {
  double frame = 0;                   // wall clock, from input to the finished screen, without presenting it
  double scene = 0;                   // wall clock, of drawing what the module reads
  double rasterizer = 0, module = 0;  // the GPU's clock
};

class MovingTimes {
public:
  // The first frames do not count: drivers compile shaders, and images are allocated.
  static constexpr std::size_t kLeftOut = 3;

  void add(const FrameTime& time);
  std::size_t count() const { return times_.size(); }

  struct Summary {
    double mean = 0, median = 0, best = 0;  // 0 without frames
  };
  Summary of(double FrameTime::*part) const;
  std::string table() const;  // of all parts; empty without frames

private:
  std::size_t leftOut_ = 0;
  std::vector<FrameTime> times_;
};

}  // namespace pellucid::harness
