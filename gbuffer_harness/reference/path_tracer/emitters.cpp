#include "reference/path_tracer/emitters.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "reference/path_tracer/sampling.h"
#include "scene/environment.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A point light at a random point of the sphere that the surface sees, weighted so that its mean is the
// sphere's irradiance. The sphere's radiance is that which gives the light's intensity from afar: I / (pi
// radius^2).
std::optional<Light> pointOf(const Light& sphere, const glm::dvec3& from, PathRandom& random) {
  const glm::dvec3 toCenter = toGlm(sphere.position) - from;
  const double distance = glm::length(toCenter);
  if (!(distance > sphere.radius)) return std::nullopt;  // within it, where --light refuses to put one
  const ConeSample sample = sampleCone(toCenter, sphere.radius, random);
  // Along the ray to the nearer of its two points on the sphere.
  const double middle = distance * sample.cosine;
  const double half2 = sphere.radius * sphere.radius - (distance * distance - middle * middle);
  const double length = middle - std::sqrt(std::max(0.0, half2));
  Light point = sphere;
  point.position = fromGlm(from + length * sample.direction);
  point.intensity *= sample.solidAngle * length * length / (std::numbers::pi * sphere.radius * sphere.radius);
  return point;
}

glm::dvec3 fromLight(const TraceScene& scene, const Light& light, const SurfacePoint& at,
                     const glm::dvec3& world) {
  const glm::dvec3 e = unshadowedIrradiance(light, world, at.normal);
  if (e == glm::dvec3(0)) return e;
  glm::dvec3 toLight = -toGlm(light.direction);
  double distance = kInfinity;
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL) {
    toLight = scene.fromWorld(toGlm(light.position)) - at.position;
    distance = glm::length(toLight);
  }
  const Ray ray{at.position + scene.offset() * at.face, glm::normalize(toLight)};
  return scene.occluded(ray, distance) ? glm::dvec3(0) : e;
}

// Radiance from a unit direction.
glm::dvec3 radianceOf(const Harmonics& harmonics, const glm::dvec3& d) {
  const std::array<double, 9> basis = harmonicBasis(fromGlm(d));
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < 9; ++i) sum += basis[i] * toGlm(harmonics[i]);
  return glm::max(sum, glm::dvec3(0));
}

}  // namespace

glm::dvec3 sampleIrradiance(const TraceScene& scene, const Emitters& emitters, const SurfacePoint& point,
                            PathRandom& random) {
  const glm::dvec3 world = scene.toWorld(point.position);
  glm::dvec3 sum(0);
  if (emitters.paint) sum += emitters.paint(world);
  for (const Light& light : emitters.lights) {
    if (light.radius == 0) {
      sum += fromLight(scene, light, point, world);
    } else if (const std::optional<Light> sampled = pointOf(light, world, random)) {
      sum += fromLight(scene, *sampled, point, world);
    }
  }
  if (emitters.environment || emitters.harmonics) {
    const glm::dvec3 direction = lambertian(point.normal, random);
    const Ray ray{point.position + scene.offset() * point.face, direction};
    // Cosine-distributed: the estimate of E is pi times the radiance.
    if (!scene.occluded(ray, kInfinity)) {
      if (emitters.environment) sum += std::numbers::pi * toGlm(emitters.environment->radiance(direction.y));
      if (emitters.harmonics) sum += std::numbers::pi * radianceOf(*emitters.harmonics, direction);
    }
  }
  return sum;
}

}  // namespace pellucid::harness::reference
