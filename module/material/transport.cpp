#include "transport.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace pellucid::material {
namespace {

// Slab numbers from the radiance leaving the medium's two faces, seen from inside.
Slab measure(const Angles& angles, const Eigen::VectorXd& near, const Eigen::VectorXd& far) {
  const Eigen::ArrayXd escape = 1 - angles.reflectance.array();
  const Eigen::ArrayXd flux = 2 * angles.weight.array() * angles.mu.array() * escape;
  // By reciprocity the hemispherical transmittance and reflectance at normal incidence are the radiances
  // that leave along the normal under unit radiance from everywhere.
  const double normal = escape[angles.normal] / (angles.ior * angles.ior);
  return {(flux * far.array()).sum(), normal * far[angles.normal], (flux * near.array()).sum(),
          normal * near[angles.normal]};
}

}  // namespace

// With S, D the sum and difference of the radiance in directions +mu and -mu, isotropic scattering
// gives mu dS/dtau = -D, mu dD/dtau = -S + albedo sum_j w_j S_j, hence S'' = A S with
// A_ij = (delta_ij - albedo w_j) / mu_i^2. Scaling row i by sqrt(w_i) mu_i makes A symmetric.
Medium::Medium(const Angles& angles, const Coefficients& coefficients)
    : angles_(&angles), extinction_(coefficients.extinction()) {
  const Eigen::VectorXd root = angles.weight.cwiseSqrt();
  const Eigen::VectorXd ratio = root.cwiseQuotient(angles.mu);
  Eigen::MatrixXd symmetric = -coefficients.albedo() * ratio * ratio.transpose();
  symmetric.diagonal() += angles.mu.cwiseAbs2().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  modes_ = root.cwiseProduct(angles.mu).cwiseInverse().asDiagonal() * solver.eigenvectors();

  Eigen::VectorXd square = solver.eigenvalues().cwiseMax(0);
  // The eigenvalues are good to 1e-16 of the largest, 1/mu_min^2, which is not enough for the smallest
  // as the albedo nears 1. It also solves (1 - albedo) = albedo kappa^2 sum w mu^2 / (1 - kappa^2 mu^2),
  // a fixed point that gains a factor kappa^2 per step.
  if (square[0] < 1e-3) {
    const double absorbed = coefficients.absorption / coefficients.scattering;
    for (int step = 0; step < 6; ++step) {
      const Eigen::ArrayXd mu2 = angles.mu.array().square();
      square[0] = absorbed / (angles.weight.array() * mu2 / (1 - square[0] * mu2)).sum();
    }
  }
  decay_ = square.cwiseSqrt();
}

// A source at one face is the mean of an even and an odd problem about the middle of the layer, in which
// mode k is cosh or sinh and -S'/S at the near face is kappa tanh(kappa L/2) or kappa coth(kappa L/2).
// The far face sees half the difference of the two solutions; it is solved for as such, with
// coth - tanh = 2 / sinh(kappa L), so that nothing cancels in thick layers.
Response Medium::respond(double thickness, const Eigen::VectorXd& reflectance,
                         const Eigen::MatrixXd& source) const {
  // Below this optical depth nothing is distinguishable from no layer, and 2/L stays finite.
  const double depth = std::max(thickness * extinction_, 1e-12);
  const Eigen::Index n = decay_.size();
  Eigen::VectorXd even(n), odd(n), gap(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double kappa = decay_[k];
    const double x = kappa == 0 ? 0 : kappa * depth / 2;
    if (x < 1e-5) {  // coth x = 1/x + x/3, 1/sinh 2x = 1/2x - x/3
      even[k] = kappa * x;
      odd[k] = 2 / depth + kappa * x / 3;
      gap[k] = odd[k] - even[k];
    } else {
      even[k] = kappa * std::tanh(x);
      odd[k] = kappa / std::tanh(x);
      gap[k] = 2 * kappa / std::sinh(2 * x);
    }
  }

  // Face condition I+ - r I- = source, with I+- = (S +- mu (-S')) / 2.
  const Eigen::VectorXd pass = (1 - reflectance.array()) / 2;
  const Eigen::VectorXd bounce = (1 + reflectance.array()) / 2 * angles_->mu.array();
  const Eigen::MatrixXd passed = pass.asDiagonal() * modes_;
  const Eigen::MatrixXd bounced = bounce.asDiagonal() * modes_;
  const Eigen::MatrixXd slope = angles_->mu.asDiagonal() * modes_;
  const Eigen::PartialPivLU<Eigen::MatrixXd> evenSystem(passed + bounced * even.asDiagonal());
  const Eigen::PartialPivLU<Eigen::MatrixXd> oddSystem(passed + bounced * odd.asDiagonal());
  const Eigen::MatrixXd oddModes = oddSystem.solve(source / 2);
  const Eigen::MatrixXd gapModes = gap.asDiagonal() * oddModes;
  const Eigen::MatrixXd difference = evenSystem.solve(bounced * gapModes);  // even - odd amplitudes

  Response response;
  response.far = (modes_ * difference - slope * (even.asDiagonal() * difference - gapModes)) / 2;
  response.near = modes_ * oddModes - slope * (odd.asDiagonal() * oddModes) + response.far;
  return response;
}

Slab Medium::slab(double thickness) const {
  const Response response = respond(thickness, angles_->reflectance, angles_->entrance);
  return measure(*angles_, response.near, response.far);
}

Response Medium::layer(double thickness) const {
  const Eigen::Index n = decay_.size();
  return respond(thickness, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Identity(n, n));
}

Slab layeredSlab(const Angles& angles, std::span<const Response* const> layers) {
  const Eigen::Index n = angles.mu.size();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);

  // From the far face back: `behind` turns downward radiance on the current interface into what comes
  // back up; `through` into the radiance that arrives at the far face from inside.
  Eigen::MatrixXd behind = angles.reflectance.asDiagonal();
  Eigen::MatrixXd through = identity;
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const Response& own = **layer;
    // Radiance going down below the layer, all bounces between it and what lies behind summed.
    const Eigen::MatrixXd below = (identity - own.near * behind).partialPivLu().solve(own.far);
    through = through * below;
    behind = own.near + own.far * behind * below;
  }
  // The near face reflects likewise.
  const Eigen::MatrixXd system = identity - angles.reflectance.asDiagonal() * behind;
  const Eigen::VectorXd entered = system.partialPivLu().solve(angles.entrance);
  return measure(angles, behind * entered, through * entered);
}

double caseEigenvalue(const Coefficients& coefficients) {
  const double albedo = coefficients.albedo();
  const double absorbed = coefficients.absorption / coefficients.extinction();
  if (albedo <= 0) return coefficients.extinction();
  if (absorbed <= 0) return 0;
  // f(x) = albedo atanh(x) / x - 1 rises from -absorbed to infinity. Near 0 it is written without
  // cancellation: atanh(x) / x - 1 = x^2/3 + x^4/5 + ...
  const auto f = [&](double x) {
    const double x2 = x * x;
    const double excess = x < 0.02 ? x2 * (1.0 / 3 + x2 * (1.0 / 5 + x2 / 7)) : std::atanh(x) / x - 1;
    return albedo * excess - absorbed;
  };
  double low = 0, high = 1;
  for (int step = 0; step < 100 && high - low > 1e-15 * high; ++step) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2 * coefficients.extinction();
}

}  // namespace pellucid::material
