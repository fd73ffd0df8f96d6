// Light from all around through thin parts, pixel by pixel in double precision.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/gather_kernel.h"
#include "reference/surface.h"

namespace pellucid::harness::reference {

class Ambient {
public:
  // Keeps references to all three.
  Ambient(const Capture& capture, const SurfaceReader& surfaces,
          const std::vector<PellucidMaterial>& materials);

  // Exitance besides what the irradiance image makes: T(h) of what arrives at the hidden face, less what the
  // visible face does not return of its own. 0 without a back depth, and without an environment and hidden
  // irradiance. `material`: from 0.
  glm::dvec3 at(const Surface& surface, std::size_t material) const;

  // Irradiance of a face with a unit normal in world space.
  static glm::dvec3 irradiance(const Harmonics& environment, const glm::dvec3& normal);

private:
  const Capture& capture_;
  const SurfaceReader& surfaces_;
  const std::vector<PellucidMaterial>& materials_;
  std::vector<std::optional<GatherKernel>> kernels_;  // of models that have a profile
};

}  // namespace pellucid::harness::reference
