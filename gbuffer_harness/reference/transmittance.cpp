#include "reference/transmittance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.h"

namespace pellucid::harness::reference {
namespace {

// `perVariance`: 1/2 for the integral of R(sqrt(r^2 + d^2)), 1 for thesis eq. 2.11 as printed.
double gaussianSum(const PellucidMaterial& m, int channel, double d, double perVariance) {
  double sum = 0;
  for (unsigned i = 0; i < m.gaussianCount; ++i)
    sum += double(m.gaussianWeight[channel][i]) *
           std::exp(-d * d * perVariance / double(m.gaussianVariance[channel][i]));
  return sum;
}

double channelTransmittance(const PellucidMaterial& m, int channel, double d) {
  if (m.thinWalled) return double(m.wallTransmittance[channel]);
  const float* p = m.transmittance[channel];
  switch (m.transmittanceModel) {
    case PELLUCID_TRANSMITTANCE_EXP2:
      return double(p[0]) * std::exp(-double(p[1]) * d) + double(p[2]) * std::exp(-double(p[3]) * d);
    case PELLUCID_TRANSMITTANCE_SINH_EXP:
      return double(p[0]) / std::sinh(double(p[1]) * d + double(p[2])) +
             double(p[3]) * std::exp(-double(p[4]) * d);
    case PELLUCID_TRANSMITTANCE_GAUSSIANS:
      return gaussianSum(m, channel, d, 0.5);
    case PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED:
      return gaussianSum(m, channel, d, 1);
    case PELLUCID_TRANSMITTANCE_LINEAR:
      return std::max(0.0, 1 - d / double(p[0]));
    default:
      throw InputError("", "transmittanceModel", "unknown model " + std::to_string(m.transmittanceModel));
  }
}

}  // namespace

glm::dvec3 transmittance(const PellucidMaterial& m, double thickness) {
  return {channelTransmittance(m, 0, thickness), channelTransmittance(m, 1, thickness),
          channelTransmittance(m, 2, thickness)};
}

double halfThickness(const PellucidMaterial& m) {
  const auto sum = [&](double d) { return glm::dot(transmittance(m, d), glm::dvec3(1)); };
  const double half = 0.5 * sum(0);
  double low = 1e-3, high = 1000;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (sum(middle) > half ? low : high) = middle;
  }
  return low;
}

bool isOpaque(const PellucidMaterial& m, double thickness) {
  constexpr double kLeast = 2e-5;
  const glm::dvec3 t = transmittance(m, thickness);
  return std::max({t.r, t.g, t.b}) < kLeast;
}

}  // namespace pellucid::harness::reference
