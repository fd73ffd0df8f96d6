// Light-space gather. Light that enters the lit surface at y with flux F leaves x with exitance F (1 - m) K(r, h) and comes
// back as diffused irradiance F m R(r), r = |x - y| in mm; docs/how-it-works.md derives K.
#ifndef PELLUCID_GATHER_GLSL
#define PELLUCID_GATHER_GLSL

#include "shared/pellucid_shared.h"

// A slab of thickness h: log2 of T(h) e^{q h}, and q in powers of 2 per mm. T(h) itself has no bound in its logarithm.
struct GatherSlab {
  vec3 logarithm, decay;
};

// Place of a thickness among the entries, which are at equal steps of h / (h + scale).
float gatherPlace(vec4 lengths, float h) {
  return h / (h + lengths.w) * float(PELLUCID_GATHER_ENTRIES - 1); // scale > 0
}

// Interpolates between an entry of GatherConstants and the next. a, b, c: the logarithm and its step, the decay and its
// step.
GatherSlab gatherSlab(vec4 a, vec4 b, vec4 c, float fraction) {
  return GatherSlab(a.rgb + fraction * vec3(a.w, b.rg), vec3(b.zw, c.x) + fraction * c.yzw);
}

// Integral of K(r, h) over the ring between the distances `near` and `far` from x: T [e^{-q (near - h)} - e^{-q (far - h)}] is
// exact for slabs. Where h grows with r, as on spheres, K falls like T(r), with a slope that is within 14 % a line in q, for q
// up to 5 kappa: before h, to second order, and beyond h by the part `curved`, 0 to 1. The channel that spreads furthest
// decides the slope, because light of the others comes from rings that are small beside it.
vec3 gatherTransmitted(vec4 lengths, GatherSlab slab, float curved, float h, float near, float far) {
  float begins = max(near, h), before = 0.69314718 * (begins - near);
  vec3 q = slab.decay;
  float kappa = 2.0 / 0.69314718 / lengths.z; // of that channel, in powers of 2: at most the least q, above 0
  float slope = 0.2 + 0.8 * kappa / min(min(q.r, q.g), q.b), decay = mix(1.0, slope, curved);
  vec3 logarithm = slab.logarithm - q * h;
  vec3 begin = exp2(logarithm - q * (decay * (begins - h))), end = exp2(logarithm - q * (decay * (far - h)));
  return (begin - end) / decay + begin * q * (before + 0.5 * before * before * slope * q);
}

// Integral of Burley's profile over the ring, 1 - cdf = e^{-r / d} / 4 + 3/4 e^{-r / 3d}; inverse3d = 0: no profile.
vec3 gatherReflected(vec3 inverse3d, float near, float far) {
  vec3 a = exp(-inverse3d * near), b = exp(-inverse3d * far);
  return 0.25 * (a * a * a - b * b * b) + 0.75 * (a - b);
}

// How much further than the nearest point of the lit surface the share u of the samples lies, at most:
// exponential, of a length that grows with u from the material's shortest to its longest. u < 1.
float gatherSpread(vec4 lengths, float u) { return -log(1.0 - u) * lengths.x * exp2(lengths.y * u); }

// Square of the radius around a foot at distance t where the distance is t + spread.
float gatherSquaredRadius(float t, float spread) { return spread * (spread + 2.0 * t); }

#endif
