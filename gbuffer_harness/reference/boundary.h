// Fresnel's equations at a smooth boundary between two indices of refraction.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pellucid::harness::reference {

// Reflectance of unpolarized light that arrives where the index is 1 at one of `ior` (relative); 1 where
// reflection is total. cosine: of the incident angle, [0, 1].
inline double fresnel(double cosine, double ior) {
  const double sine2 = (1 - cosine * cosine) / (ior * ior);
  if (sine2 >= 1) return 1;
  const double inner = std::sqrt(1 - sine2);
  // Both sums are above 0: inner is, and ior.
  const double s = (cosine - ior * inner) / (cosine + ior * inner);
  const double p = (ior * cosine - inner) / (ior * cosine + inner);
  return 0.5 * (s * s + p * p);
}

// The direction (unit) behind the boundary; normal: unit, against the incident direction.
inline glm::dvec3 refracted(const glm::dvec3& direction, const glm::dvec3& normal, double ior) {
  const glm::dvec3 sideways = (direction - glm::dot(direction, normal) * normal) / ior;
  return sideways - std::sqrt(std::max(0.0, 1 - glm::dot(sideways, sideways))) * normal;
}

}  // namespace pellucid::harness::reference
