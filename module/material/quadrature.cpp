#include "quadrature.h"

#include <cmath>
#include <numbers>

namespace pellucid::material {

std::vector<Node> gaussLegendre(int n, double a, double b) {
  std::vector<Node> rule(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    // Newton on P_n from Tricomi's estimate of the root; five steps reach double precision.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), derivative = 1;
    for (int step = 0; step < 6; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1);
      x -= p1 / derivative;
    }
    rule[static_cast<std::size_t>(i)] = {a + (b - a) * (1 - x) / 2,
                                         (b - a) / ((1 - x * x) * derivative * derivative)};
  }
  return rule;
}

double fresnelReflectance(double cosine, double ior) {
  const double inside = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double s = (cosine - ior * inside) / (cosine + ior * inside);
  const double p = (ior * cosine - inside) / (ior * cosine + inside);
  return (s * s + p * p) / 2;
}

Angles makeAngles(double ior, AngleCount count) {
  // Radiance has a kink at the critical angle and the transmission a square root beside it, so the
  // two sides get rules of their own and the transmitted side is integrated over the cosine outside,
  // nu: mu^2 = 1 - (1 - nu^2) / n^2, n^2 mu dmu = nu dnu.
  const int trapped = count == AngleCount::Fine ? 10 : 6, transmitted = count == AngleCount::Fine ? 14 : 8;
  // A direction of vanishing weight reads the radiance at mu = 1 without taking part in the transport;
  // the square root of the weight must stay well above the rounding of the eigenvectors.
  constexpr double kProbeWeight = 1e-10;

  struct Direction {
    double mu, weight, reflectance, entrance;
  };
  std::vector<Direction> directions;
  const double critical = std::sqrt(1 - 1 / (ior * ior));
  if (critical > 0)
    for (const Node& node : gaussLegendre(trapped, 0, critical))
      directions.push_back({node.x, node.weight, 1, 0});
  for (const Node& node : gaussLegendre(transmitted + (critical > 0 ? 0 : trapped), 0, 1)) {
    const double mu = std::sqrt(1 - (1 - node.x * node.x) / (ior * ior));
    const double reflectance = fresnelReflectance(node.x, ior);
    directions.push_back(
        {mu, node.weight * node.x / (ior * ior * mu), reflectance, ior * ior * (1 - reflectance)});
  }
  const double reflectance = fresnelReflectance(1, ior);
  directions.push_back({1, kProbeWeight, reflectance, ior * ior * (1 - reflectance)});

  const auto size = static_cast<Eigen::Index>(directions.size());
  Angles angles{
      ior,     Eigen::VectorXd(size), Eigen::VectorXd(size), Eigen::VectorXd(size), Eigen::VectorXd(size),
      size - 1};
  for (Eigen::Index i = 0; i < size; ++i) {
    const Direction& direction = directions[static_cast<std::size_t>(i)];
    angles.mu[i] = direction.mu;
    angles.weight[i] = direction.weight;
    angles.reflectance[i] = direction.reflectance;
    angles.entrance[i] = direction.entrance;
  }
  return angles;
}

}  // namespace pellucid::material
