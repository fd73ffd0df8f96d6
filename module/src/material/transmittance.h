// The transmittance models: their parameters, and T(d) of a material's channel as compute/translucency/transmission.glsl evaluates
// it. All CPU code takes them from here but gbuffer_harness/reference, which checks them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "findings.h"
#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

constexpr uint32_t kLastTransmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
static_assert(PELLUCID_SHADER_TRANSMITTANCE_EXP2 == PELLUCID_TRANSMITTANCE_EXP2 &&
              PELLUCID_SHADER_TRANSMITTANCE_SINH_EXP == PELLUCID_TRANSMITTANCE_SINH_EXP &&
              PELLUCID_SHADER_TRANSMITTANCE_LINEAR == PELLUCID_TRANSMITTANCE_LINEAR);

// True for models that the gather's kernel follows from.
inline bool canBeGathered(uint32_t model) {
  return model == PELLUCID_TRANSMITTANCE_EXP2 || model == PELLUCID_TRANSMITTANCE_SINH_EXP;
}

// Whether a1 e^(-k1 d) + a2 e^(-k2 d) is positive and falls with d: its slope has one zero at most, so its
// signs at 0 and where the slower term is left say all. The tolerance is what fits in floats miss.
inline bool falls(const float (&t)[5]) {
  const double a1 = static_cast<double>(t[0]), k1 = static_cast<double>(t[1]);
  const double a2 = static_cast<double>(t[2]), k2 = static_cast<double>(t[3]);
  if (!(k1 >= 0 && k2 >= 0)) return false;
  const double most = std::abs(a1) + std::abs(a2), tolerance = 1e-4 * most;
  const double slower = k1 < k2 ? a1 : k1 > k2 ? a2 : a1 + a2;
  return a1 + a2 >= -tolerance && slower >= -tolerance &&
         a1 * k1 + a2 * k2 >= -1e-4 * most * std::max(k1, k2);
}

// Of EXP2 and SINH_EXP, which 5 parameters alone define; d >= 0 mm.
inline double transmittance(uint32_t model, const float* parameters, double d) {
  const auto p = [&](int i) { return static_cast<double>(parameters[i]); };
  if (model == PELLUCID_TRANSMITTANCE_EXP2) return p(0) * std::exp(-p(1) * d) + p(2) * std::exp(-p(3) * d);
  // 1 / sinh y = 2 e^{-y} / (1 - e^{-2y}) does not overflow.
  const double y = p(1) * d + p(2);
  return p(0) * 2 * std::exp(-y) / -std::expm1(-2 * y) + p(3) * std::exp(-p(4) * d);
}

// Largest T(0): what fits in floats miss.
constexpr double kMostTransmittance = 1.001;

// A thin wall's T(d) is constant: EXP2 with rates 0.
inline uint32_t modelOf(const PellucidMaterial& m) {
  return m.thinWalled != 0 ? static_cast<uint32_t>(PELLUCID_TRANSMITTANCE_EXP2) : m.transmittanceModel;
}

// Refuses parameters that the model cannot have.
inline void checkTransmittance(const PellucidMaterial& m, Findings& out) {
  if (m.thinWalled != 0) return;
  const bool gaussians = m.transmittanceModel == PELLUCID_TRANSMITTANCE_GAUSSIANS ||
                         m.transmittanceModel == PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED;
  if (gaussians && m.gaussianCount == 0)
    out.error("gaussianCount", "is 0, but the transmittance model needs Gaussians");
  constexpr const char* field = "transmittance";
  for (int c = 0; c < 3; ++c) {
    const float(&t)[5] = m.transmittance[c];
    if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2 && !falls(t))
      out.error(field, "of channel ", c, " grows with thickness: a1 ", t[0], ", k1 ", t[1], ", a2 ", t[2],
                ", k2 ", t[3]);
    if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP && !(t[1] >= 0 && t[2] > 0 && t[4] >= 0))
      out.error(field, "of channel ", c, " needs kappa >= 0, z > 0, c >= 0; they are ", t[1], ", ", t[2],
                ", ", t[4]);
    // The gather takes kappa for the slowest rate, by which light goes furthest.
    else if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP && t[3] != 0 && t[4] < t[1])
      out.error(field, "of channel ", c, " has c ", t[4], " below kappa ", t[1], "; use c >= kappa, or b = 0 in place of ", t[3]);
    else if (canBeGathered(m.transmittanceModel) && transmittance(m.transmittanceModel, t, 0) > kMostTransmittance)
      out.error(field, "of channel ", c, " gives a slab without thickness ", static_cast<float>(transmittance(m.transmittanceModel, t, 0)),
                " of the light; scale the amplitudes ", t[0], " and ", t[m.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2 ? 2 : 3], " so that it is at most 1");
    if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_LINEAR && !(t[0] > 0))
      out.error(field, "of channel ", c, " has dmax ", t[0], "; must be > 0");
  }
}

// The parameters as shaders read them: LINEAR has 1 / dmax, so that they do not divide.
inline std::array<float, 5> shaderParameters(const PellucidMaterial& m, int channel) {
  if (m.thinWalled != 0) return {m.wallTransmittance[channel], 0, 0, 0, 0};
  const float(&t)[5] = m.transmittance[channel];
  // 1e-30: the inverse is finite.
  const bool linear = m.transmittanceModel == PELLUCID_TRANSMITTANCE_LINEAR;
  return {linear ? 1 / std::max(t[0], 1e-30f) : t[0], t[1], t[2], t[3], t[4]};
}

// c of e^{-c d^2 / v} of the models that take the profile's Gaussians, of variance v.
inline double gaussianExponent(uint32_t model) {
  return model == PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED ? 1 : 0.5;
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
      const double c = gaussianExponent(m.transmittanceModel);
      double sum = 0;
      for (uint32_t i = 0; i < std::min<uint32_t>(m.gaussianCount, PELLUCID_MAX_GAUSSIANS); ++i)
        sum += static_cast<double>(m.gaussianWeight[channel][i]) *
               std::exp(-c * d * d / static_cast<double>(m.gaussianVariance[channel][i]));
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

// The diffusion length 1 / kappa, in mm: the depth over which light falls to 1/e. Mean of the channels; 0 where
// T's model has no rate.
inline float diffusionLength(const PellucidMaterial& m) {
  if (m.thinWalled != 0) return 0;
  float sum = 0;
  for (const float(&t)[5] : m.transmittance) {
    float rate = 0;
    if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP)
      rate = t[1];
    else if (m.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2)
      // The slower of the two terms that are there reaches farther.
      rate = t[0] > 0 && t[2] > 0 ? std::min(t[1], t[3]) : t[0] > 0 ? t[1] : t[3];
    if (!(rate > 0)) return 0;
    sum += 1 / rate;
  }
  return sum / 3;
}

}  // namespace pellucid
