// T(d) of a material's channel, as compute/lib/transmittance.glsl evaluates it: once for all of the CPU's
// code but gbuffer_harness/reference, which checks it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/pellucid.h"

namespace pellucid {

// Of EXP2 and SINH_EXP, which 5 parameters alone define; d >= 0 mm.
inline double transmittance(uint32_t model, const float* parameters, double d) {
  const auto p = [&](int i) { return static_cast<double>(parameters[i]); };
  if (model == PELLUCID_TRANSMITTANCE_EXP2) return p(0) * std::exp(-p(1) * d) + p(2) * std::exp(-p(3) * d);
  // 1 / sinh y = 2 e^{-y} / (1 - e^{-2y}) does not overflow.
  const double y = p(1) * d + p(2);
  return p(0) * 2 * std::exp(-y) / -std::expm1(-2 * y) + p(3) * std::exp(-p(4) * d);
}

// T of a thin wall, or of any model; NaN for one that is not known.
inline double transmittance(const PellucidMaterial& m, size_t channel, double d) {
  if (m.thinWalled != 0) return static_cast<double>(m.wallTransmittance[channel]);
  switch (m.transmittanceModel) {
    case PELLUCID_TRANSMITTANCE_EXP2:
    case PELLUCID_TRANSMITTANCE_SINH_EXP:
      return transmittance(m.transmittanceModel, m.transmittance[channel], d);
    case PELLUCID_TRANSMITTANCE_GAUSSIANS:
    case PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED: {
      const double twice = m.transmittanceModel == PELLUCID_TRANSMITTANCE_GAUSSIANS ? 2 : 1;
      double sum = 0;
      for (uint32_t i = 0; i < std::min<uint32_t>(m.gaussianCount, PELLUCID_MAX_GAUSSIANS); ++i)
        sum += static_cast<double>(m.gaussianWeight[channel][i]) *
               std::exp(-d * d / (twice * static_cast<double>(m.gaussianVariance[channel][i])));
      return sum;
    }
    case PELLUCID_TRANSMITTANCE_LINEAR:
      return std::max(1 - d / static_cast<double>(m.transmittance[channel][0]), 0.0);
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

// The depth below `high` at which a falling T is `least`; `high` where T does not fall that far.
template <class T>
double depthOf(const T& transmittance, double least, double high) {
  double low = 0;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (transmittance(middle) > least ? low : high) = middle;
  }
  return low;
}

constexpr double kMostThickness = 1000;  // mm

// mm at which the mean of the channels' T is half of T(0), from .001 to 1000.
inline double halfThickness(const PellucidMaterial& m) {
  const auto sum = [&](double d) {
    return transmittance(m, 0, d) + transmittance(m, 1, d) + transmittance(m, 2, d);
  };
  return std::max(depthOf(sum, 0.5 * sum(0), kMostThickness), 1e-3);
}

// mm beyond which each channel's T is below 2e-5, the twentieth of a half's rounding; INFINITY where it never
// is.
inline double opaqueThickness(const PellucidMaterial& m) {
  const auto most = [&](double d) {
    return std::max({transmittance(m, 0, d), transmittance(m, 1, d), transmittance(m, 2, d)});
  };
  return most(kMostThickness) > 2e-5 ? INFINITY : depthOf(most, 2e-5, kMostThickness);
}

}  // namespace pellucid
