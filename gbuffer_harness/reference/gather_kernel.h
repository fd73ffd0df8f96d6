// The kernels of the light-space gather (docs/how-it-works.md) in double precision. Lengths in mm.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::harness::reference {

// Where light entered, seen from where it leaves: the segment between them and the outward normals.
struct GatherPath {
  double distance;  // |x - y|
  double depth;     // thickness of the slab that the pair looks like, 0..distance
  double facing;    // m = (1 + N_x . N_y) / 2: 1 same way, 0 opposite
};

// to: x - y. Normals are unit.
GatherPath gatherPath(const glm::dvec3& to, const glm::dvec3& exitNormal, const glm::dvec3& entryNormal);

// A body's factors of the diffused irradiance and of the light that comes through.
struct BodyFactors {
  glm::dvec3 returned{1}, through{1};
};

class GatherKernel {
public:
  // Throws InputError when T(d) is not one of the models the gather takes.
  explicit GatherKernel(const PellucidMaterial& material);

  // Exitance per flux, 1/mm^2: T(h) q(h) e^{-q(h) (r - h)} / (2 pi r).
  glm::dvec3 transmitted(double distance, double depth) const;

  // Normalized reflectance profile, 1/mm^2; 0 in channels that do not diffuse.
  glm::dvec3 reflected(double distance) const;

  // Sideways decay of a slab, 1/mm: sqrt(kappa^2 + (pi / (h + extrapolation))^2).
  double decay(int channel, double depth) const;

  // Part of that profile within a distance; 0 in channels that do not diffuse.
  glm::dvec3 reflectedWithin(double distance) const;

  // rho
  glm::dvec3 reflectance() const;

  // R(h) / rho of a slab, by Kubelka & Munk 1931 from T(h) and rho: R = a - sqrt(s T^2 + a^2 - 1) with
  // a = (1 / rho + rho) / 2, and s such that a slab without medium sends back what its boundary does.
  glm::dvec3 slabReflectance(double depth) const;

  // Factors at a surface of that thickness (mm; INFINITY: not known) and mean curvature (1/mm, positive where
  // convex).
  BodyFactors body(double thickness, double curvature) const;

  // Part of even light from all around on a ball of that radius (mm) that leaves it: diffusion with an
  // extrapolated boundary, fitted to rho and T.
  glm::dvec3 leavesBall(double radius) const;

  // How far to both sides of a point its curvature is measured, mm: the depth from which light comes back. 0
  // without diffusion.
  double bodyReach() const;

  // Distance beyond which `transmitted` of every channel integrates to less than `share` of T(0) over a
  // plane.
  double radius(double share) const;

private:
  // T(h) q(h) / (2 pi) and q(h) at one depth.
  struct Slab {
    glm::dvec3 weight, decay;
  };

  // Diffusion in balls, mm.
  struct Diffusion {
    double rho, entering, source, beyond;
  };
  // Part of the light that leaves a ball, where the light is a spherical harmonic of that order, 0 or 1.
  double leaves(int channel, int order, double radius) const;
  // Three factors of a whole ball in one channel: light that comes back beyond that of a slab of its
  // diameter, light that comes through, less 1, and light that comes back in place of light through.
  glm::dvec3 ball(int channel, double radius) const;
  Diffusion diffusion(int channel) const;
  double transmittance(int channel, double depth) const;

  PellucidMaterial material_;
  double longest_;           // depth of the last table entry, mm
  std::vector<Slab> table_;  // uniform in sqrt(depth), linear in between: below 1e-5 of the value
  std::array<double, 3> slowest_, extrapolation_, profile_;
};

}  // namespace pellucid::harness::reference
