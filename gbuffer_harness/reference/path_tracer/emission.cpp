#include "reference/path_tracer/emission.h"

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/cone.h"
#include "reference/sampling.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// Parallel light: through a point of the disc that the sphere shows it.
Ray throughDisc(const TraceScene::Sphere& bounds, const glm::dvec3& direction, PathRandom& random) {
  const Frame frame(direction);
  const double radius = bounds.radius * std::sqrt(random.uniform()), angle = kTwoPi * random.uniform();
  return {bounds.center + radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) -
              2 * bounds.radius * direction,
          direction};
}

// A direction from a point into the cone around the sphere, and the cone's solid angle; all around where the
// point lies within.
struct Aimed {
  glm::dvec3 direction;
  double solidAngle;
};
Aimed aim(const TraceScene::Sphere& bounds, const glm::dvec3& from, PathRandom& random) {
  const glm::dvec3 toCenter = bounds.center - from;
  if (!(glm::length(toCenter) > bounds.radius)) return {uniformDirection(random), 2 * kTwoPi};
  const ConeSample sample = sampleCone(toCenter, bounds.radius, random);
  return {sample.direction, sample.solidAngle};
}

std::optional<Emission> fromLight(const TraceScene& scene, const Light& light,
                                  const TraceScene::Sphere& bounds, PathRandom& random) {
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) {
    const glm::dvec3 direction = glm::normalize(toGlm(light.direction));
    const double area = std::numbers::pi * bounds.radius * bounds.radius;
    return Emission{throughDisc(bounds, direction, random), area * light.intensity * toGlm(light.color)};
  }
  // Irradiance on a surface that faces the light at the length of one unit is the intensity that way, cone
  // and range included; both are functions of where the ray goes, so that it is asked for where it arrives.
  glm::dvec3 from = scene.fromWorld(toGlm(light.position));
  if (light.radius > 0) {
    const glm::dvec3 normal = uniformDirection(random);
    from += light.radius * scene.millimetersPerUnit() * normal;
    const Aimed aimed = aim(bounds, from, random);
    const double cosine = glm::dot(normal, aimed.direction);
    if (!(cosine > 0)) return std::nullopt;
    // Radiance I / (pi r^2), over the sphere's area 4 pi r^2.
    const double square = scene.millimetersPerUnit() * scene.millimetersPerUnit();
    return Emission{{from, aimed.direction},
                    4 * cosine * aimed.solidAngle * light.intensity * square * toGlm(light.color)};
  }
  const Aimed aimed = aim(bounds, from, random);
  const Ray ray{from, aimed.direction};
  const std::optional<SurfacePoint> arrival = scene.first(ray, 0);
  if (!arrival) return std::nullopt;
  const glm::dvec3 way = arrival->position - from;
  const glm::dvec3 e = unshadowedIrradiance(light, scene.toWorld(arrival->position), -aimed.direction);
  return Emission{ray, aimed.solidAngle * glm::dot(way, way) * e};
}

}  // namespace

std::optional<Emission> emit(const TraceScene& scene, const Emitters& emitters,
                             const TraceScene::Sphere& bounds, PathRandom& random) {
  const std::size_t count = emitters.lights.size() + (emitters.environment ? 1 : 0);
  if (count == 0) return std::nullopt;
  const auto chosen =
      std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
  std::optional<Emission> emission;
  if (chosen < emitters.lights.size()) {
    emission = fromLight(scene, emitters.lights[chosen], bounds, random);
  } else {
    const glm::dvec3 direction = uniformDirection(random);
    const double area = std::numbers::pi * bounds.radius * bounds.radius;
    emission = Emission{throughDisc(bounds, direction, random),
                        2 * kTwoPi * area * toGlm(emitters.environment->radiance(-direction.y))};
  }
  if (emission) emission->flux *= static_cast<double>(count);
  return emission;
}

}  // namespace pellucid::harness::reference
