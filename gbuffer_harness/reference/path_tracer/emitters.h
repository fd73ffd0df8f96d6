// Lights and environment of a traced scene.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/trace_scene.h"
#include "scene/environment.h"

namespace pellucid::harness::reference {

struct Emitters {
  std::vector<Light> lights;  // world, as in captures; those with a radius are spheres
  std::optional<Environment> environment;
  std::optional<Harmonics> harmonics;  // radiance from all around, in the world; counts where it is above 0
  // Irradiance by world position on top of both: painted test patterns.
  std::function<glm::dvec3(const glm::dvec3&)> paint;
};

// An unbiased estimate of the irradiance that arrives at a point of a surface, R, G, B: shadow rays to every
// light, to a random point of those that are spheres, and one ray into the environment and the harmonics.
glm::dvec3 sampleIrradiance(const TraceScene& scene, const Emitters& emitters, const SurfacePoint& point,
                            PathRandom& random);

}  // namespace pellucid::harness::reference
