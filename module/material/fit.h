// The functions of thickness the shaders evaluate, fitted to exact transmittance.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "pellucid/pellucid.h"

namespace pellucid::material {

struct Sample {
  double thickness;  // mm
  double transmittance;
  double scale;  // > 0; what an error is measured against: the transmittance itself for a relative error
};

// Parameters in the order of PellucidMaterial::transmittance, in float as the shaders get them.
struct Curve {
  PellucidTransmittanceModel model;
  std::array<float, 5> parameters;
};

// T(d) of an EXP2 or SINH_EXP curve; d >= 0 mm.
double evaluate(const Curve& curve, double thickness);

// Positive, decreasing and at most 1 for every d >= 0.
bool isTransmittance(const Curve& curve);

struct Fit {
  Curve curve;
  double error;  // largest |fit - T| / scale over the samples; infinite when no valid curve was found
};

struct Fits {
  Fit exp2, sinhExp;
};

// Least worst error over at least 8 samples in increasing order. `decay` is the exact asymptotic
// decay of T if known; `extinction` > 0 the scale of its fall at small thickness; both in 1/mm. The
// curves pass isTransmittance.
Fits fitTransmittance(std::span<const Sample> samples, std::optional<double> decay, double extinction);

// An EXP2 curve as SINH_EXP: a / sinh(kappa d + z) is 2 a e^{-z} e^{-kappa d} for large z.
Curve asSinhExp(const Curve& curve);

}  // namespace pellucid::material
