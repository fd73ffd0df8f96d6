// Random numbers of one path: a stream that seed, pixel and sample name, whichever thread walks it.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

namespace pellucid::harness::reference {

class PathRandom {
public:
  PathRandom(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : state_(mix(mix(mix(seed) ^ pixel) ^ sample)) {}

  // [0, 1)
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  glm::dvec3 direction() {
    const double z = 2 * uniform() - 1, angle = 2 * std::numbers::pi * uniform();
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  // Cosine-distributed about a unit vector.
  glm::dvec3 lambertian(const glm::dvec3& about) {
    const glm::dvec3 v = about + direction();
    const double length = glm::length(v);
    return length > 1e-6 ? v / length : about;
  }

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

}  // namespace pellucid::harness::reference
