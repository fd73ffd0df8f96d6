// The cone of directions in which a point sees a sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "reference/path_tracer/random.h"

namespace pellucid::harness::reference {

// Two unit vectors perpendicular to a unit vector z and to each other.
struct Frame {
  glm::dvec3 x, y;
  explicit Frame(const glm::dvec3& z)
      : x(glm::normalize(glm::cross(std::abs(z.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), z))),
        y(glm::cross(z, x)) {}
};

struct ConeSample {
  glm::dvec3 direction;  // unit
  double cosine;         // of its angle to the sphere's center
  double solidAngle;     // of the cone
};

// Uniform over the cone (Pharr et al. 2023, 6.2.4). toCenter: longer than the radius, which is above 0.
inline ConeSample sampleCone(const glm::dvec3& toCenter, double radius, PathRandom& random) {
  const double distance = glm::length(toCenter), sine2 = radius * radius / (distance * distance);
  const double part = sine2 / (1 + std::sqrt(1 - sine2));  // 1 - cos of the cone, without cancellation
  const double cosine = 1 - part * random.uniform(), angle = 2 * std::numbers::pi * random.uniform();
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const glm::dvec3 axis = toCenter / distance;
  const Frame frame(axis);
  return {cosine * axis + sine * (std::cos(angle) * frame.x + std::sin(angle) * frame.y), cosine,
          2 * std::numbers::pi * part};
}

}  // namespace pellucid::harness::reference
