// Pieces of distance fields.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid::harness {

// Union with the crease rounded over a width of about k (Quilez, polynomial smooth minimum).
inline double smoothUnion(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

inline double smoothIntersection(double a, double b, double k) { return -smoothUnion(-a, -b, k); }

// Bound on the distance to an ellipsoid, exact to first order at its surface (Quilez).
inline double ellipsoidDistance(const glm::dvec3& p, const glm::dvec3& radii) {
  const double k0 = glm::length(p / radii);
  const double k1 = glm::length(p / (radii * radii));
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

}  // namespace pellucid::harness
