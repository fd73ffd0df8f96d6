// Random numbers and directions of paths, and Fresnel's equations where they meet a smooth boundary.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

namespace pellucid::harness::reference {

// Random numbers of one path: a stream that seed, pixel and sample name, whichever thread walks it.
class PathRandom {
public:
  PathRandom(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : state_(mix(mix(mix(seed) ^ pixel) ^ sample)) {}

  // [0, 1)
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

private:
  // SplitMix64 (Steele, Lea & Flood 2014).
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15u); }

  std::uint64_t state_;
};

inline glm::dvec3 uniformDirection(PathRandom& random) {
  const double z = 2 * random.uniform() - 1, angle = 2 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// Cosine-distributed about a unit vector.
inline glm::dvec3 lambertian(const glm::dvec3& about, PathRandom& random) {
  const glm::dvec3 v = about + uniformDirection(random);
  const double length = glm::length(v);
  return length > 1e-6 ? v / length : about;
}

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
