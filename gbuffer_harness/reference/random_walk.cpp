#include "reference/random_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/parallel.h"
#include "reference/boundary.h"
#include "reference/sampling.h"

namespace pellucid::harness::reference {
namespace {

constexpr double kSurface = 1e-9;  // mm; how near to the surface sphere tracing stops
constexpr double kInwards = 1e-5;  // mm; points that come from float depths are off by less
constexpr int kChunks = 64;

class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  // [0, 1)

private:
  std::mt19937_64 engine_;
};

// Irradiance where one walk leaves; 0 if it is absorbed.
double walk(const WalkShape& shape, const WalkMedium& medium, const glm::dvec3& point,
            const glm::dvec3& toLight, Random& random) {
  const double extinction = medium.scattering + medium.absorption;
  const glm::dvec3 outward = shape.normal(point);
  const glm::dvec3 from = lambertian(outward, random);
  if (random.uniform() < fresnel(glm::dot(from, outward), medium.ior)) return 0;
  glm::dvec3 direction = refracted(-from, outward, medium.ior), position = point - kInwards * outward;
  for (;;) {
    double length = -std::log(1 - random.uniform()) / extinction;
    while (const std::optional<double> exit = shape.exit(position, direction, length)) {
      position += *exit * direction;
      length -= *exit;
      const glm::dvec3 normal = shape.normal(position);
      const double cosine = std::abs(glm::dot(direction, normal));
      if (random.uniform() >= fresnel(cosine, 1 / medium.ior)) {
        const double facing = glm::dot(normal, toLight);
        return facing > 0 && !shape.shadows(position, toLight) ? facing : 0;
      }
      direction -= 2 * glm::dot(direction, normal) * normal;
    }
    position += length * direction;
    if (random.uniform() * extinction >= medium.scattering) return 0;
    direction = uniformDirection(random);
  }
}

}  // namespace

std::optional<double> WalkPolyhedron::exit(const glm::dvec3& origin, const glm::dvec3& direction,
                                           double limit) const {
  std::optional<double> least;
  for (const Plane& plane : planes_) {
    const double rate = glm::dot(plane.normal, direction);
    if (!(rate > 0)) continue;
    const double t = std::max(0.0, (plane.offset - glm::dot(plane.normal, origin)) / rate);
    if (t < limit && (!least || t < *least)) least = t;
  }
  return least;
}

glm::dvec3 WalkPolyhedron::normal(const glm::dvec3& point) const {
  return std::max_element(planes_.begin(), planes_.end(),
                          [&](const Plane& a, const Plane& b) {
                            return glm::dot(a.normal, point) - a.offset <
                                   glm::dot(b.normal, point) - b.offset;
                          })
      ->normal;
}

std::optional<double> WalkSphere::exit(const glm::dvec3& origin, const glm::dvec3& direction,
                                       double limit) const {
  const double b = glm::dot(origin, direction);
  const double inside = std::max(0.0, radius_ * radius_ - glm::dot(origin, origin));
  const double t = -b + std::sqrt(b * b + inside);
  return t < limit ? std::optional(std::max(t, 0.0)) : std::nullopt;
}

glm::dvec3 WalkTorus::fromTube(const glm::dvec3& point) const {
  const glm::dvec3 flat = point - glm::dot(point, axis_) * axis_;
  const double length = glm::length(flat);
  return length > 0 ? point - major_ / length * flat : point;
}

std::optional<double> WalkTorus::exit(const glm::dvec3& origin, const glm::dvec3& direction,
                                      double limit) const {
  // A start on the surface is one that goes inwards.
  for (double t = 1e-6; t < limit;) {
    const double inside = minor_ - glm::length(fromTube(origin + t * direction));
    if (inside < kSurface) return t;
    t += inside;
  }
  return std::nullopt;
}

glm::dvec3 WalkTorus::normal(const glm::dvec3& point) const { return glm::normalize(fromTube(point)); }

bool WalkTorus::shadows(const glm::dvec3& point, const glm::dvec3& toLight) const {
  const double beyond = 4 * (major_ + minor_);
  // Past the surface it starts from; grazing light misses at most this much of a shadow.
  for (double t = 1e-3 * minor_; t < beyond;) {
    const double outside = glm::length(fromTube(point + t * toLight)) - minor_;
    if (outside < kSurface) return true;
    t += outside;
  }
  return false;
}

WalkResult exitance(const WalkShape& shape, const WalkMedium& medium, const glm::dvec3& point,
                    const glm::dvec3& toLight, std::size_t walks, std::uint64_t seed, int jobs) {
  const std::size_t each = (walks + kChunks - 1) / kChunks;
  double sums[kChunks] = {}, squares[kChunks] = {};
  parallelRows(kChunks, jobs, [&](int chunk) {
    Random random(seed * kChunks + static_cast<std::uint64_t>(chunk));
    for (std::size_t i = 0; i < each; ++i) {
      const double e = walk(shape, medium, point, toLight, random);
      sums[chunk] += e;
      squares[chunk] += e * e;
    }
  });
  double sum = 0, square = 0;
  for (int chunk = 0; chunk < kChunks; ++chunk) {
    sum += sums[chunk];
    square += squares[chunk];
  }
  const double count = static_cast<double>(each * kChunks), mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, square / count - mean * mean) / count)};
}

}  // namespace pellucid::harness::reference
