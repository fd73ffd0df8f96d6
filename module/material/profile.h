// The diffusion profile: Burley's two exponentials fitted to transport, and the Gaussian sums the shaders
// convolve with.
#pragma once

#include <span>

#include "pellucid/pellucid.h"
#include "transport.h"

namespace pellucid::material {

// Radius of Burley's profile that holds 99.9 % of its energy, in units of d: the root of
// 1/4 e^{-x} + 3/4 e^{-x/3} = 1e-3.
inline constexpr double kBurleyRadius999 = 19.8602;

// d (mm) of Burley's profile for the half-space under Lambertian light from outside: the d whose half-plane
// step differs least from that of transport. The step is then off by at most 0.013 for albedos up to 0.999
// and ior up to 1.5, 0.023 up to albedo 1 and 0.03 up to ior 3. (The published s(A) hold for ior 1 only; at
// 1.4 their step is off by 0.1.)
double burleyDistance(const Coefficients& coefficients, double ior);

// The same for a medium given by its reflectance: the albedo of the half-space of equal rho.
double equivalentAlbedo(const Angles& angles, double rho);

// Gaussians that stand for Burley's profile of d = 1, variances ascending, weights of sum 1.
struct UnitGaussians {
  std::span<const double> variance, weight;
  double edgeError;  // largest difference of the half-plane steps
};

// count in 1..PELLUCID_MAX_GAUSSIANS.
UnitGaussians burleyGaussians(int count);

// Radius that holds 99.9 % of the energy of a Gaussian sum.
double gaussianRadius999(std::span<const double> variance, std::span<const double> weight);

}  // namespace pellucid::material
