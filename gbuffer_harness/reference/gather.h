// Light-space gather over every texel of the shadow maps (docs/how-it-works.md): what the GPU's samples
// converge to.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/gather_kernel.h"
#include "reference/light.h"
#include "reference/surface.h"

namespace pellucid::harness::reference {

// The light of a pixel besides its diffused irradiance. RGB.
struct Gathered {
  glm::dvec3 transmitted{0};  // exitance of what came through
  // Irradiance that enters hidden from the camera and faces the way the pixel does, less what the lights'
  // diffused irradiance stands for in its place: in each light alone, so that lights add up.
  glm::dvec3 returned{0};
  glm::dvec3 factor{1};  // of the diffused irradiance, 0..2: what comes back of the body over a half-space's
};

class Gather {
public:
  // Keeps references to the camera's surfaces. `diffused`: what light the camera sees has been diffused; else
  // only what enters hidden counts. Lights whose maps hold back faces bring nothing. Throws InputError when a
  // map lacks a matrix or a material has no kernel.
  Gather(const Capture& capture, const SurfaceReader& surfaces,
         const std::vector<PellucidMaterial>& materials, bool diffused = true);

  // `material`: index into the list. Safe from several threads.
  Gathered at(const Surface& surface, std::size_t material) const;

private:
  struct Texel {
    glm::dvec3 position, normal;  // mm; unit, towards the light's side. World
    glm::dvec3 flux;              // RGB irradiance times mm^2
    double area;                  // of the surface, mm^2; of a grazed one at most five times the texel's
    double within;                // part of the flux that enters within the area
    bool seen;                    // by the camera
    double exit;                  // mm along the light to the nearest back face behind; INFINITY: not known
    std::uint8_t material;        // index + 1 of what light enters; 0: not known
  };
  struct Block {
    glm::dvec3 center;
    double radius;  // mm
    std::vector<Texel> texels;
  };
  using Blocks = std::vector<Block>;
  struct Sums;
  // A point that leaves light, world.
  struct Exit {
    glm::dvec3 position;  // mm
    glm::dvec3 normal;    // of the quad, smoother than the facet's, which the module's probes have
    std::size_t material = 0;
    double reach = 0;  // facetReach() there
  };
  // An exit among a light's rays, as its maps say.
  struct Place {
    glm::dvec3 toLight{0, 0, 1};
    glm::dvec3 ownIrradiance{0};  // that the light itself brings to the exit
    double tolerance = 1e-12;     // mm that an exit depth of its own may be off by
    double shadowed = 0;          // 1: its own light ray has left the medium before the exit, 0: it has not
    glm::dvec3 axis{0, 0, 1};     // between toLight and the inward normal
    double behind = 0;            // mm along the axis from where that ray has left the medium to the exit
    const std::vector<ShadowView>* views = nullptr;  // of the light's maps
  };

  // The texels of one of the light's maps, that of the last view. A texel that an earlier one contains counts
  // there.
  Blocks collect(const Light& light, const ShadowMap& map, const std::vector<ShadowView>& views) const;
  Sums sums(const Blocks& blocks, const Exit& exit, const Place& place) const;
  Place placeOf(std::size_t light, const Exit& exit) const;
  // Part of what enters at a texel that reaches the exit through the medium.
  double inside(const Texel& texel, const Exit& exit, const Place& place) const;
  // 1 where the straight path from the exit to a texel lies in the body, at that part of the path; 0 where a
  // map's exit lies before, with air or an opaque body behind it. `to`: from the texel to the exit.
  double pathInside(const glm::dvec3& to, const Exit& exit, const Place& place, double part) const;
  // Two pixels at the surface, facing the camera, mm: what a facet reaches over.
  double facetReach(const Surface& surface) const;
  // Around a surface, 1/mm, positive where convex: from the quads that lie `reach` mm to both sides in the
  // image. 0 where it does not go on.
  double meanCurvature(const Surface& surface, double reach) const;
  // Thickness of the body, mm: a slab's at any angle, a ball's diameter. INFINITY: not known.
  double thickness(const Surface& surface) const;
  BodyFactors bodyAt(const Surface& surface, std::size_t material) const;
  // Normal of what the camera shows at a lit point of a map, world; nothing where it shows something else
  // there. `tolerance`: half a texel; `uncertain`: along the light; `offset`: along normals; scene units.
  // `biased`: a slope bias or an offset moved the map.
  std::optional<glm::dvec3> shownNormal(const glm::dvec3& world, const glm::dvec3& toLight, double tolerance,
                                        double uncertain, double offset, bool biased) const;
  // off: scene units along the normal that the point may be off by, besides the tolerance along the ray.
  bool cameraSees(const glm::dvec3& world, const glm::dvec3& normal, double tolerance, double off) const;

  const Capture& capture_;
  const SurfaceReader& surfaces_;
  double mm_;                                         // per scene unit
  std::vector<std::optional<GatherKernel>> kernels_;  // none of thin walls
  std::vector<double> radii_;
  std::vector<Blocks> lights_;
  std::vector<std::vector<ShadowView>> views_;  // of the lights' maps
  bool diffused_;
};

}  // namespace pellucid::harness::reference
