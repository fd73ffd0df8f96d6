// Light-space gather. Light that enters the lit surface at y with flux F leaves x with exitance
// F K_T(|x - y|), K_T(r) = -T'(r) / (2 pi r): over a plane at distance d the kernel integrates to T(d), so
// slabs are exact; docs/gather.md derives it. Lengths in mm.
#ifndef PELLUCID_GATHER_GLSL
#define PELLUCID_GATHER_GLSL

const float kTwoPi = 6.28318531;

// Offsets are drawn from four densities over the plane across the light ray, in turn: K_T's own shape for
// a slab at distance t and for a surface at distance 0, each with a slow and a fast rate k,
//   p(rho) = k e^{-k (s - t)} / (2 pi s), s = sqrt(rho^2 + t^2), sampled exactly by s = t - ln(1 - u) / k.
// The mean of the four weighs every sample (balance heuristic). With t = 0, s = rho <= r keeps
// K_T / p bounded whatever the map holds.
float gatherDensity(float rho, float t, float k) {
  float s = sqrt(rho * rho + t * t);
  return k * exp(-k * (s - t)) / (kTwoPi * max(s, 1.0e-6));
}

float gatherMixture(float rho, float t, vec2 rates) {
  return 0.25 * (gatherDensity(rho, t, rates.x) + gatherDensity(rho, 0.0, rates.x) +
                 gatherDensity(rho, t, rates.y) + gatherDensity(rho, 0.0, rates.y));
}

// Sample i of n, n a multiple of 4: the middle of its stratum in u, the golden angle in direction.
vec2 gatherOffset(uint i, uint n, float t, vec2 rates) {
  uint technique = i & 3u;
  float from = (technique & 1u) == 0u ? t : 0.0;
  float k = technique < 2u ? rates.x : rates.y;
  float u = (float(i) + 0.5) / float(n); // in (0, 1); the techniques interleave
  float s = from - log(1.0 - u) / k;
  float rho = sqrt(max(s * s - from * from, 0.0));
  // A quarter turn between techniques, the golden angle within each.
  float angle = 2.39996323 * float(i / 4u) + 1.57079633 * float(technique);
  return rho * vec2(cos(angle), sin(angle));
}

#endif
