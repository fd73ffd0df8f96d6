// Conversions between the capture's arrays and GLM, and what formulas of scenes share.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "capture/capture.h"

namespace pellucid::harness {

inline double square(double x) { return x * x; }

inline glm::dvec3 toGlm(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline std::array<double, 3> fromGlm(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

inline glm::dmat4 toGlm(const Matrix& m) {
  glm::dmat4 result;
  for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
  return result;
}
inline Matrix fromGlm(const glm::dmat4& m) {
  Matrix result;
  for (int i = 0; i < 16; ++i) result[static_cast<std::size_t>(i)] = m[i / 4][i % 4];
  return result;
}

}  // namespace pellucid::harness
