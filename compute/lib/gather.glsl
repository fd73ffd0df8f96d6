// Light-space gather. Light that enters the lit surface at y with flux F leaves x with exitance
// F (1 - m) K(r, h) and comes back as diffused irradiance F m R(r), r = |x - y|; docs/gather.md derives K.
// Lengths in mm.
#ifndef PELLUCID_GATHER_GLSL
#define PELLUCID_GATHER_GLSL

#include "shared/pellucid_shared.h"

// A slab of thickness h: log2 of T(h) e^{q h}, and q in powers of 2 per mm, both polynomials in
// v = h / (h + scale). T(h) itself has no bound in its logarithm.
struct GatherSlab {
  vec3 logarithm, decay;
};

GatherSlab gatherSlab(GatherConstants g, float h) {
  float v = h / (h + g.lengths.w); // scale > 0
  vec3 logarithm = g.slab[PELLUCID_GATHER_TERMS - 1].rgb, decay = g.decay[PELLUCID_GATHER_TERMS - 1].rgb;
  for (int i = PELLUCID_GATHER_TERMS - 2; i >= 0; --i) {
    logarithm = logarithm * v + g.slab[i].rgb;
    decay = decay * v + g.decay[i].rgb;
  }
  return GatherSlab(logarithm, decay);
}

// Integral of K(r, h) over the ring that a plane with x at distance 0 from its center shows between the
// distances `near` and `far` from x, T [e^{-q (near - h)} - e^{-q (far - h)}]: slabs are exact however
// wide the rings are. Where h reaches into the ring (r = h on a sphere), K is T q / (2 pi r) up to h.
vec3 gatherTransmitted(GatherSlab slab, float h, float near, float far) {
  float begins = max(near, h);
  vec3 begin = exp2(slab.logarithm - slab.decay * begins);
  vec3 end = exp2(slab.logarithm - slab.decay * max(far, begins));
  return begin * (1.0 + 0.69314718 * slab.decay * (begins - near)) - end;
}

// The same of Burley's profile, 1 - cdf = e^{-r / d} / 4 + 3/4 e^{-r / 3d}; inverse3d = 0: no profile.
vec3 gatherReflected(vec3 inverse3d, float near, float far) {
  vec3 a = exp(-inverse3d * near), b = exp(-inverse3d * far);
  return 0.25 * (a * a * a - b * b * b) + 0.75 * (a - b);
}

// Radius at which the share u of the samples lies inside, for a slab at distance t. Distances beyond t
// are exponential, of a length that grows with u from the material's shortest to its longest; u < 1.
float gatherRadius(GatherConstants g, float t, float u) {
  float s = -log(1.0 - u) * g.lengths.x * exp2(g.lengths.y * u);
  return sqrt(s * s + 2.0 * t * s);
}

#endif
