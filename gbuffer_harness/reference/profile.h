// Radial diffusion profiles R(r) in double precision: formulas, those of compiled materials, and the energy
// that one sends from a pixel. Lengths in mm, integrals over the plane 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::harness::reference {

// Every profile answers three questions:
//   cumulative(r)    energy within r, 0..1
//   ringDensity(r)   its derivative, 2 pi r R(r), 1/mm; finite at r = 0
//   finestScale()    length over which ringDensity changes by itself, > 0

// R(r) = (e^{-r/d} + e^{-r/3d}) / (8 pi d r), Christensen & Burley 2015 eq. 3.
struct BurleyProfile {
  double distance;  // d, > 0
  double cumulative(double r) const;
  double ringDensity(double r) const;
  double finestScale() const { return distance; }
};

// R(r) = sum_i w_i / (2 pi v_i) e^{-r^2 / 2 v_i}, d'Eon et al. 2007; weights sum to 1.
struct GaussianProfile {
  std::vector<double> variance, weight;
  double cumulative(double r) const;
  double ringDensity(double r) const;
  double finestScale() const;
};

using Profile = std::variant<BurleyProfile, GaussianProfile>;

double cumulative(const Profile& p, double r);
double ringDensity(const Profile& p, double r);

// Radius outside of which `fraction` of the energy lies, rounded up by at most 1e-6 of itself.
double radiusOfTail(const Profile& p, double fraction);

// Three channels of a profile on one grid that is fine near r = 0 (uniform in sqrt(r)), cubic in
// between. Measured error of both functions: below 1e-6 of their maximum.
class ProfileTable {
public:
  // R, G, B and a lane of padding, so that sums over the channels fill whole vector registers.
  using Lanes = glm::dvec4;

  ProfileTable(const std::array<Profile, 3>& profiles, double radius);

  double radius() const { return radius_; }

  // R(r), 1/mm^2, 0 < r < radius(). Takes r^2, which is what distances come as.
  Lanes value(double rSquared) const {
    const double r = std::sqrt(rSquared);
    return evaluate(ring_.data(), std::sqrt(r) * cellsPerRoot_) * (1 / (2 * std::numbers::pi * r));
  }

  // Energy within r; beyond radius() that within radius().
  Lanes cumulativeEnergy(double r) const {
    return evaluate(cumulative_.data(), std::sqrt(std::min(r, radius_)) * cellsPerRoot_);
  }

private:
  using Cubic = std::array<Lanes, 4>;  // coefficients of 1, f, f^2, f^3 for f in 0..1

  static Lanes evaluate(const Cubic* cells, double position) {
    const int cell = static_cast<int>(position);
    const double f = position - cell;
    const Cubic& k = cells[cell];
    return k[0] + f * (k[1] + f * (k[2] + f * k[3]));
  }

  static std::vector<Cubic> tabulate(const std::array<Profile, 3>& profiles, double step, std::size_t cells,
                                     double (*function)(const Profile&, double));

  double radius_, cellsPerRoot_;
  std::vector<Cubic> ring_, cumulative_;
};

// One channel's profile: Burley's where the material has a distance, else its Gaussians; nothing if the channel does not
// diffuse. Throws InputError naming the field for values no profile can have.
std::optional<Profile> channelProfile(const PellucidMaterial& material, int channel);

// Parallelogram { center + a x + b y : -1 <= a, b <= 1 }; center relative to the receiving point.
struct Parallelogram {
  glm::dvec3 center, x, y;
};

// Integral of R(|y|) over the parallelogram, exact for any profile and any distance, R's infinity at
// r = 0 included. In polar coordinates around the foot of the perpendicular (height t), the radial
// integral is the cumulative energy, which leaves one integral over the angle along each edge:
//   1/(2 pi) sum_edges int cumulative(sqrt(rho^2 + t^2)) - cumulative(t) dtheta.
// Measured error, table included: below 1e-7 of the whole profile.
ProfileTable::Lanes integratedEnergy(const ProfileTable& profile, const Parallelogram& p);

// The same with 2x2 Gauss-Legendre points: relative error falls with the fourth power of
// size / distance.
ProfileTable::Lanes sampledEnergy(const ProfileTable& profile, const Parallelogram& p);

}  // namespace pellucid::harness::reference
