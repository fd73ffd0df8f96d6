// Light-space gather over every texel of the shadow maps (docs/gather.md): what the GPU's samples converge
// to.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "capture/capture.h"
#include "reference/gather_kernel.h"
#include "reference/surface.h"

namespace pellucid::harness::reference {

// Light at one pixel from what is lit and hidden from the camera. RGB.
struct Gathered {
  glm::dvec3 transmitted{0};  // exitance
  glm::dvec3 entering{0};     // irradiance that reaches the pixel as diffusion does
  // Share of the diffusion's profile that lies there, the mean of all lights by how strongly they light it,
  // less what the surface's curvature adds: down to -1/10.
  glm::dvec3 displaced{0};
};

class Gather {
public:
  // Keeps references to the camera's surfaces. shadowBias: scene units. Throws InputError when a map lacks a
  // matrix or a material has no kernel.
  Gather(const Capture& capture, const SurfaceReader& surfaces,
         const std::vector<PellucidMaterial>& materials, double shadowBias);

  // `material`: index into the list. Pixels without a normal see every texel as opposite. Safe from several
  // threads.
  Gathered at(const Surface& surface, std::size_t material) const;

  // Lit texels that the camera does not see, over all lights.
  std::size_t hiddenTexels() const;

private:
  struct Texel {
    glm::dvec3 position, normal;  // mm; unit, towards the light's side. World
    glm::dvec3 flux;              // RGB irradiance times mm^2
    double area;                  // of the surface, mm^2
  };
  struct Block {
    glm::dvec3 center;
    double radius;  // mm
    std::vector<Texel> texels;
  };
  using Blocks = std::vector<Block>;

  // Of one of the light's maps; a texel that an earlier one contains counts there.
  Blocks collect(const Light& light, std::size_t map, double bias) const;
  // Around a surface with a normal, 1/mm, positive where convex: from what lies `reach` mm beside it in the
  // image. 0 where it does not go on.
  double meanCurvature(const Surface& surface, double reach) const;
  bool cameraSees(const glm::dvec3& world, const glm::dvec3& normal, double tolerance) const;

  const Capture& capture_;
  const SurfaceReader& surfaces_;
  double mm_;  // per scene unit
  std::vector<GatherKernel> kernels_;
  std::vector<double> radii_;
  std::vector<Blocks> lights_;
};

}  // namespace pellucid::harness::reference
