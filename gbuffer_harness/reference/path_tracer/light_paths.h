// Truth by paths from the lights: light enters in its own, refracted direction.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/path_tracer/emitters.h"
#include "reference/path_tracer/medium.h"
#include "reference/path_tracer/trace_scene.h"
#include "reference/path_tracer/truth.h"

namespace pellucid::harness::reference {

// Paths begin at a light, refract into a body by Fresnel's equations (Lambertian where the medium has no
// boundary), walk through it, and add what they carry to the pixel that sees where they leave. A pixel's
// value is the mean exitance of the surface it shows, times albedo / rho as in TruthTracer: an average over
// the pixel, in which pixels along silhouettes have the part that is surface.
class LightPaths {
public:
  // Throws InputError for a scene without end, for painted irradiance and where rho of a medium is 0.
  LightPaths(const Capture& capture, const TraceScene& scene, const std::vector<TraceMedium>& media,
             const Emitters& emitters);

  // Adds paths [sums.samples, sums.samples + count) x pixels with a material: `samples` counts paths for
  // each pixel. The result depends on the seed and not on `jobs`.
  void trace(TruthSums& sums, std::uint64_t count, std::uint64_t seed, int jobs,
             const std::function<void()>& progress) const;

private:
  struct Arrival {
    std::size_t pixel;
    glm::dvec3 value;      // not 0
    std::uint64_t sample;  // of this call's
  };
  std::optional<Arrival> path(std::uint64_t number, std::uint64_t seed) const;
  void addInOrder(const std::vector<std::vector<Arrival>>& arrivals, TruthSums& sums) const;
  std::optional<Arrival> seen(const SurfacePoint& point, const glm::dvec3& flux) const;

  const TraceScene& scene_;
  const std::vector<TraceMedium>& media_;
  const Emitters& emitters_;
  TraceScene::Sphere bounds_;
  int width_, height_;
  glm::dmat4 clipFromWorld_;
  glm::dvec3 eye_, forward_;  // of the scene's coordinates
  glm::dvec3 parallel_;       // along the rays of an orthographic camera
  bool orthographic_;
  glm::dvec2 pixelSize_;  // mm on a plane at distance 1 mm, or of any plane of an orthographic camera
  std::vector<std::uint8_t> material_;
  std::vector<glm::dvec3> scale_;
  std::size_t pixels_;  // with a material
};

}  // namespace pellucid::harness::reference
