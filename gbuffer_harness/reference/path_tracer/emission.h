// Light as it leaves an emitter.
#pragma once

#include <optional>

#include "reference/path_tracer/emitters.h"

namespace pellucid::harness::reference {

struct Emission {
  Ray ray;          // of the scene's coordinates
  glm::dvec3 flux;  // R, G, B, in units of irradiance times mm^2: the mean over emissions is all that arrives
};

// A random ray from one of the emitters towards the sphere around the scene. Nothing where the ray drawn
// carries no light.
std::optional<Emission> emit(const TraceScene& scene, const Emitters& emitters,
                             const TraceScene::Sphere& bounds, PathRandom& random);

}  // namespace pellucid::harness::reference
