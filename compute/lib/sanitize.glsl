#ifndef PELLUCID_SANITIZE_GLSL
#define PELLUCID_SANITIZE_GLSL

const float kLargestHalf = 65504.0;

// Finite and >= 0. Written as comparisons because max() may return either operand for NaN.
vec3 sanitize(vec3 v) {
  for (int c = 0; c < 3; ++c) v[c] = v[c] > 0.0 ? min(v[c], kLargestHalf) : 0.0;
  return v;
}

#endif
