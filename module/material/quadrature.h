// Directions and boundary coefficients of a plane-parallel medium of one index of refraction.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace pellucid::material {

struct Node {
  double x, weight;
};

// Gauss-Legendre rule on [a, b]; n >= 1.
std::vector<Node> gaussLegendre(int n, double a, double b);

// Unpolarized Fresnel reflectance from outside an interface of relative index `ior` >= 1; `cosine` of
// the angle outside. The same for the refracted ray from inside.
double fresnelReflectance(double cosine, double ior);

// Directions inside the medium with 0 < mu <= 1, and what the Fresnel boundary does to each. Radiance
// is averaged over azimuth; unit radiance over the hemisphere outside is unit flux.
struct Angles {
  double ior;
  Eigen::VectorXd mu, weight;   // integral over mu in [0, 1]: sum of weight f(mu); sums to 1
  Eigen::VectorXd reflectance;  // internal; 1 beyond the critical angle
  Eigen::VectorXd entrance;     // radiance just inside under unit radiance from outside: n^2 (1 - r)
  Eigen::Index normal;          // index of mu = 1
};

// Fine: slabs good to 1e-6. Coarse: to 6e-5, at a quarter of the cost.
enum class AngleCount { Fine, Coarse };

Angles makeAngles(double ior, AngleCount count = AngleCount::Fine);

}  // namespace pellucid::material
