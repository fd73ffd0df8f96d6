// Bounds of numbers from files: one rule for all readers.
#pragma once

#include <algorithm>
#include <cmath>

namespace pellucid::harness {

// The rounding of a float32, or of a decimal of seven digits: relative, absolute at a bound of 0.
inline constexpr double kRounding = 1e-6;

inline double roundingAt(double bound) { return kRounding * (bound == 0 ? 1 : std::abs(bound)); }

// The bound, where `value` lies beyond it by no more than a rounding; else `value`.
inline double fitted(double value, double least, double most) {
  if (value < least && value >= least - roundingAt(least)) return least;
  if (value > most && value <= most + roundingAt(most)) return most;
  return value;
}

}  // namespace pellucid::harness
