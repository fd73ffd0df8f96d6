#include "baselines/kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::bench {

namespace {

double largest(const float (&channels)[3]) { return *std::max_element(channels, channels + 3); }
double smallest(const float (&channels)[3]) { return *std::min_element(channels, channels + 3); }

// Energy within r, Christensen & Burley 2015.
double burleyCumulative(double d, double r) {
  return 1 - 0.25 * std::exp(-r / d) - 0.75 * std::exp(-r / (3 * d));
}

// Energy of the profile integrated along one axis, from the center to x on one side.
double edge(const PellucidMaterial& m, int channel, double x) {
  double sum = 0;
  for (uint32_t i = 0; i < m.gaussianCount; ++i)
    sum += 0.5 * m.gaussianWeight[channel][i] *
           std::erf(x / std::sqrt(2.0 * static_cast<double>(m.gaussianVariance[channel][i])));
  return sum;
}

}  // namespace

std::vector<glm::vec4> sharedGaussians(const PellucidMaterial& material) {
  constexpr int kCount = 6, kSamples = 200;
  // From well below the narrowest channel's mean path to the widest channel's tail, geometrically.
  const double low = 0.3 * std::pow(smallest(material.burleyDistance), 2);
  const double high =
      std::pow(largest(material.radius), 2) / 14;  // 99.9 % of a Gaussian lies within 3.7 sigma
  std::vector<glm::vec4> result(kCount);
  double variance[kCount];
  for (int i = 0; i < kCount; ++i) {
    variance[i] = low * std::pow(high / low, i / (kCount - 1.0));
    result[static_cast<size_t>(i)].w =
        static_cast<float>(std::sqrt(variance[i] - (i > 0 ? variance[i - 1] : 0)));
  }
  for (int c = 0; c < 3; ++c) {
    // Least squares of the energy within r, r in geometric steps over the same range, weights >= 0:
    // coordinate descent, which converges because the problem is convex.
    double basis[kCount][kSamples], residual[kSamples];
    for (int k = 0; k < kSamples; ++k) {
      const double r = 0.1 * std::sqrt(low) * std::pow(100 * std::sqrt(high / low), k / (kSamples - 1.0));
      for (int i = 0; i < kCount; ++i) basis[i][k] = 1 - std::exp(-r * r / (2 * variance[i]));
      residual[k] = burleyCumulative(material.burleyDistance[c], r);
    }
    double weight[kCount] = {}, total = 0;
    for (int sweep = 0; sweep < 5000; ++sweep)
      for (int i = 0; i < kCount; ++i) {
        double dot = 0, norm = 0;
        for (int k = 0; k < kSamples; ++k) {
          dot += basis[i][k] * residual[k];
          norm += basis[i][k] * basis[i][k];
        }
        const double step = std::max(dot / norm, -weight[i]);
        weight[i] += step;
        for (int k = 0; k < kSamples; ++k) residual[k] -= step * basis[i][k];
      }
    for (const double w : weight) total += w;
    for (int i = 0; i < kCount; ++i)
      result[static_cast<size_t>(i)][c] = static_cast<float>(weight[i] / total);
  }
  return result;
}

std::vector<glm::vec4> separableKernel(const PellucidMaterial& material, int taps) {
  const double radius = largest(material.radius);
  const int side = taps / 2;
  const auto offset = [&](int i) { return radius * i * std::abs(i) / (static_cast<double>(side) * side); };
  std::vector<glm::vec4> result;
  // A tap stands for the cell between the midpoints to its neighbors.
  const auto add = [&](int i) {
    const double from = i == -side ? -radius : 0.5 * (offset(i - 1) + offset(i));
    const double to = i == side ? radius : 0.5 * (offset(i) + offset(i + 1));
    glm::vec4 tap(0, 0, 0, static_cast<float>(offset(i)));
    for (int c = 0; c < 3; ++c) {
      const double energy = edge(material, c, to) - edge(material, c, from);
      tap[c] = static_cast<float>(energy / (2 * edge(material, c, radius)));
    }
    result.push_back(tap);
  };
  add(0);
  for (int i = -side; i <= side; ++i)
    if (i != 0) add(i);
  return result;
}

std::vector<glm::vec4> burleyDiskKernel(const PellucidMaterial& material, int samples) {
  const float* d = material.burleyDistance;
  const double widest = largest(material.burleyDistance);
  const double goldenAngle = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<glm::vec4> result = {{d[0], d[1], d[2], 0}};
  for (int i = 0; i < samples; ++i) {
    const double share = (i + 0.5) / samples;
    double low = 0, high = 100 * widest;  // 100 d holds all but 1e-14
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (burleyCumulative(widest, middle) < share ? low : high) = middle;
    }
    const double r = high, angle = i * goldenAngle;
    const double profile =
        (std::exp(-r / widest) + std::exp(-r / (3 * widest))) / (8 * std::numbers::pi * widest * r);
    result.emplace_back(std::cos(angle), std::sin(angle), r, 1 / profile);
  }
  return result;
}

}  // namespace pellucid::bench
