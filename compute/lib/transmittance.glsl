// T(d): fraction of the flux entering one face of a slab that leaves the other. d in mm, >= 0.
#ifndef PELLUCID_TRANSMITTANCE_GLSL
#define PELLUCID_TRANSMITTANCE_GLSL

// a1 e^{-k1 d} + a2 e^{-k2 d}
float transmittanceExp2(vec4 p, float d) {
  const float kLog2E = 1.44269504;
  float e = kLog2E * d; // once for all channels
  return p.x * exp2(-p.y * e) + p.z * exp2(-p.w * e);
}

// a / sinh(kappa d + z) + b e^{-c d}; z > 0 by construction. Written with e^{-y} so that a thick slab
// gives 0 and not 1/inf: 1/sinh y = 2 e^{-y} / (1 - e^{-2y}).
float transmittanceSinhExp(vec4 p, float c, float d) {
  float y = max(p.y * d + p.z, 1.0e-6);
  float e = exp(-y);
  // 1 - e^2 loses its bits where y is small; its series there is off by 2/15 y^4 < 1e-6.
  float denominator = y < 0.05 ? 2.0 * y * (1.0 - y * (1.0 - y * (2.0 / 3.0 - y / 3.0))) : 1.0 - e * e;
  return p.x * 2.0 * e / denominator + p.w * exp(-c * d);
}

// One term w e^{-d^2 / (2 v)} of d'Eon & Luebke 2007: R(sqrt(r^2 + d^2)) of a Gaussian sum,
// integrated over the plane.
vec3 transmittanceGaussian(vec3 weight, vec3 falloff, float d) {
  return weight * exp(-d * d * falloff);
}

#endif
