// One path of light inside a body, walked backwards from where it is seen.
#pragma once

#include <optional>

#include "reference/path_tracer/medium.h"
#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/trace_scene.h"

namespace pellucid::harness::reference {

struct WalkExit {
  SurfacePoint surface;  // where the path leaves the body: where the light came in
  glm::dvec3 weight;     // of the irradiance there, R, G, B
};

// The exitance at `start` (inside or on the boundary of start.body) is the expectation of weight times the
// irradiance at the exit. Light enters as if it came Lambertian from outside and leaves likewise: by
// reciprocity the path begins as Lambertian light that refracts into the body. Scattering by
// Henyey-Greenstein; the boundary refracts and reflects by Fresnel's equations. All channels share the path
// by spectral tracking (Kutz et al. 2017): distances are sampled for one channel, chosen by throughput, and
// weighted by the mean density over the channels that could have been (one-sample MIS, Veach 1997).
// Nothing when the path is absorbed.
std::optional<WalkExit> walk(const TraceScene& scene, const TraceMedium& medium, const SurfacePoint& start,
                             PathRandom& random);

// The rest of such a path, from a point inside the body on in this direction (unit), with weight 1.
std::optional<WalkExit> walkFrom(const TraceScene& scene, const TraceMedium& medium, int body,
                                 const glm::dvec3& position, const glm::dvec3& direction, PathRandom& random);

}  // namespace pellucid::harness::reference
