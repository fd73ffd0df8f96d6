// Directions that walks and paths draw. `Random` has uniform(), a double of [0, 1).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace pellucid::harness::reference {

template <class Random>
glm::dvec3 uniformDirection(Random& random) {
  const double z = 2 * random.uniform() - 1, angle = 2 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// Cosine-distributed about a unit vector.
template <class Random>
glm::dvec3 lambertian(const glm::dvec3& about, Random& random) {
  const glm::dvec3 v = about + uniformDirection(random);
  const double length = glm::length(v);
  return length > 1e-6 ? v / length : about;
}

}  // namespace pellucid::harness::reference
