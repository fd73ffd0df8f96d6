// Colors of a capture, as the frame takes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid::harness::reference {

// 0 to 65504, as halves hold it; NaN and infinity count as 0.
inline glm::dvec3 readColor(const float* rgb) {
  const auto read = [](float v) { return v > 0 && std::isfinite(v) ? std::min(double(v), 65504.0) : 0.0; };
  return {read(rgb[0]), read(rgb[1]), read(rgb[2])};
}

}  // namespace pellucid::harness::reference
