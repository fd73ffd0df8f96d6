// Exact radiative transport in plane-parallel layers with isotropic scattering: discrete ordinates in
// eigenmodes (Stamnes et al. 1988, Applied Optics 27:2502), layers joined by the adding method (van de
// Hulst 1980).
#pragma once

#include <Eigen/Core>
#include <span>

#include "quadrature.h"

namespace pellucid::material {

struct Coefficients {
  double scattering, absorption;  // sigma_s', sigma_a, 1/mm; their sum > 0

  double extinction() const { return scattering + absorption; }
  double albedo() const { return scattering / extinction(); }
};

struct Slab {
  double transmittance;        // hemispherical, Lambertian light from outside
  double transmittanceNormal;  // hemispherical, normal incidence
  double reflectance;          // Lambertian light from outside that entered and came back
  double reflectanceNormal;    // the same for normal incidence
};

// Radiance leaving the two faces of a layer, one column per column of the source.
struct Response {
  Eigen::MatrixXd near, far;
};

// One homogeneous medium, solved once for every thickness.
class Medium {
public:
  // `angles` must outlive the medium.
  Medium(const Angles& angles, const Coefficients& coefficients);

  // A layer of `thickness` mm (>= 0, INFINITY: half-space) whose faces send back `reflectance` of
  // what arrives from inside, with radiance `source` added just inside the near face.
  Response respond(double thickness, const Eigen::VectorXd& reflectance, const Eigen::MatrixXd& source) const;

  // A layer between black faces: what layeredSlab stacks.
  Response layer(double thickness) const;

  // The slab in air. Relative precision holds however small the transmittance.
  Slab slab(double thickness) const;

private:
  const Angles* angles_;
  double extinction_;
  Eigen::MatrixXd modes_;  // column k: sum of the up and down radiance in each direction
  Eigen::VectorXd decay_;  // kappa_k >= 0 per unit optical depth
};

// Layers between two faces to air, light from the side of the first. Each is the response to the identity
// of a layer with black faces (Medium::layer); all of the same Angles.
Slab layeredSlab(const Angles& angles, std::span<const Response* const> layers);

// The Case eigenvalue, 1/mm: asymptotically T falls as e^{-kappa d}. kappa = x sigma_t' with
// 1 = (albedo / 2x) ln((1 + x) / (1 - x)) (Case & Zweifel 1967).
double caseEigenvalue(const Coefficients& coefficients);

}  // namespace pellucid::material
