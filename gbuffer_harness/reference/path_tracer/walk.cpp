#include "reference/path_tracer/walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/path_tracer/sampling.h"

namespace pellucid::harness::reference {

namespace {

// Below this throughput a path goes on by Russian roulette alone.
constexpr double kRoulette = 0.25;

// Radii of the scene: no body reaches as far.
constexpr double kBeyond = 1.01;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// A direction at an angle with Henyey-Greenstein's distribution (1941) to `forward`.
glm::dvec3 scattered(const glm::dvec3& forward, double g, PathRandom& random) {
  if (std::abs(g) < 1e-6) return uniformDirection(random);            // below it the quotient cancels
  const double u = (1 - g * g) / (1 - g + 2 * g * random.uniform());  // denominator within 1 - |g| .. 1 + |g|
  const double cosine = std::clamp((1 + g * g - u * u) / (2 * g), -1.0, 1.0);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double angle = 2 * std::numbers::pi * random.uniform();
  // A basis without a singular direction (Duff et al. 2017).
  const double sign = std::copysign(1.0, forward.z), a = -1 / (sign + forward.z);
  const double b = forward.x * forward.y * a;
  const glm::dvec3 x(1 + sign * forward.x * forward.x * a, sign * b, -sign * forward.x);
  const glm::dvec3 y(b, sign + forward.y * forward.y * a, -forward.y);
  return sine * std::cos(angle) * x + sine * std::sin(angle) * y + cosine * forward;
}

// Which channel the next distance is sampled for: by what each could still bring.
struct Chooser {
  glm::dvec3 probability;

  Chooser(const glm::dvec3& throughput, const glm::dvec3& albedo) : probability(throughput * albedo) {
    double sum = probability.x + probability.y + probability.z;
    if (!(sum > 0)) {  // nothing scatters: what is left can only leave straight on
      probability = throughput;
      sum = probability.x + probability.y + probability.z;
    }
    probability /= sum;  // the path ends when all throughput is gone
  }
  int operator()(double u) const { return u < probability.x ? 0 : u < probability.x + probability.y ? 1 : 2; }
};

}  // namespace

std::optional<WalkExit> walk(const TraceScene& scene, const TraceMedium& medium, const SurfacePoint& start,
                             PathRandom& random) {
  // The way inside, by Fresnel's refraction, or Lambertian where the medium has no boundary.
  glm::dvec3 direction = -lambertian(start.face, random);
  double entering = 1;
  if (medium.ior != 1) {
    entering = 1 - fresnel(std::clamp(-glm::dot(direction, start.face), 0.0, 1.0), medium.ior);
    direction = refracted(direction, start.face, medium.ior);
  }
  std::optional<WalkExit> exit =
      walkFrom(scene, medium, start.body, start.position - scene.offset() * start.face, direction, random);
  if (exit) exit->weight *= entering;
  return exit;
}

std::optional<WalkExit> walkFrom(const TraceScene& scene, const TraceMedium& medium, int body,
                                 const glm::dvec3& start, const glm::dvec3& forward, PathRandom& random) {
  const glm::dvec3 extinction = medium.scattering + medium.absorption;
  const glm::dvec3 albedo = medium.scattering / extinction;
  glm::dvec3 throughput(1), position = start, direction = forward;
  const auto bounds = scene.bounds();
  for (;;) {
    // Rounding let the path slip out through the surface.
    if (bounds && glm::distance(position, bounds->center) > kBeyond * bounds->radius) return std::nullopt;
    const Chooser channel(throughput, albedo);
    const double distance = -std::log(1 - random.uniform()) / extinction[channel(random.uniform())];
    const std::optional<SurfacePoint> exit = scene.exit(body, {position, direction}, distance);
    if (exit) {
      if (exit->material == 0) return std::nullopt;  // what is opaque absorbs all
      const glm::dvec3 passed = glm::exp(-extinction * glm::distance(position, exit->position));
      throughput *= passed / glm::dot(channel.probability, passed);  // one of them is not 0: it got here
      const double cosine = std::min(1.0, std::abs(glm::dot(direction, exit->face)));
      if (medium.ior == 1 || random.uniform() >= fresnel(cosine, 1 / medium.ior))
        return WalkExit{*exit, throughput};
      direction -= 2 * glm::dot(direction, exit->face) * exit->face;
      position = exit->position - scene.offset() * exit->face;
      continue;
    }
    const glm::dvec3 passed = glm::exp(-extinction * distance);
    const double density = glm::dot(channel.probability, extinction * passed);
    // Paths of hundreds of mean free paths; what they bring is below any sum's last digit.
    if (!(density > 0)) return std::nullopt;
    throughput *= medium.scattering * passed / density;
    position += distance * direction;
    const double most = largest(throughput);
    if (!(most > 0)) return std::nullopt;
    if (most < kRoulette) {
      if (random.uniform() * kRoulette >= most) return std::nullopt;
      throughput *= kRoulette / most;
    }
    direction = scattered(direction, medium.g, random);
  }
}

}  // namespace pellucid::harness::reference
