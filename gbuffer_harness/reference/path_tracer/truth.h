// Path-traced truth of a capture: what every pixel of a translucent body sends out.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "capture/capture.h"
#include "reference/path_tracer/medium.h"
#include "reference/path_tracer/visible_surface.h"

namespace pellucid::harness::reference {

// Sums over the samples of each pixel so far.
struct TruthSums {
  int width = 0, height = 0;
  std::uint64_t samples = 0;                  // of every pixel
  std::vector<glm::dvec3> sum, sumOfSquares;  // row 0 first; 0 where there is no surface
};

// A sample is a path from the surface at a pixel's center and estimates the exitance there (walk.h), times
// albedo / rho: a flat body gives albedo times E, as a replay does. A thin wall gives albedo times the
// capture's irradiance, and its transmittance of what arrives at its other face, likewise times albedo / rho.
// Random numbers depend on seed, pixel and sample alone.
class TruthTracer {
public:
  // All arguments must outlive the tracer. Throws InputError when rho of a medium is 0.
  TruthTracer(const Capture& capture, const VisibleSurface& surface, const TraceScene& scene,
              const std::vector<TraceMedium>& media, const Emitters& emitters);

  // Adds samples [sums.samples, sums.samples + count) to every pixel; `jobs` threads, 0: all. Calls
  // `progress` after each row, from any thread.
  void trace(TruthSums& sums, std::uint64_t count, std::uint64_t seed, int jobs,
             const std::function<void()>& progress) const;

private:
  glm::dvec3 sample(std::size_t pixel, std::uint64_t number, std::uint64_t seed) const;
  glm::dvec3 sampleWall(std::size_t pixel, const TraceMedium::Wall& wall, PathRandom& random) const;

  const Capture& capture_;
  const VisibleSurface& surface_;
  const TraceScene& scene_;
  const std::vector<TraceMedium>& media_;
  const Emitters& emitters_;
  std::vector<glm::dvec3> scale_;  // albedo / rho of each pixel
};

// The mean and its standard error, as the layer of a capture.
Truth truthOf(const TruthSums& sums);

// The sums that give a truth of so many samples, up to the rounding of its floats.
TruthSums sumsOf(const Truth& truth);

}  // namespace pellucid::harness::reference
