#ifndef PELLUCID_SANITIZE_GLSL
#define PELLUCID_SANITIZE_GLSL

const float kLargestHalf = 65504.0;

// Finite and >= 0. Written as comparisons because max() may return either operand for NaN.
vec3 sanitize(vec3 v) {
  for (int c = 0; c < 3; ++c) v[c] = v[c] > 0.0 ? min(v[c], kLargestHalf) : 0.0;
  return v;
}

// v rounded to the nearest half, ties to even. Image stores may truncate (Vulkan leaves it open), which
// darkens by up to 1e-3 a pass; what is already a half is stored as it is on every device. v >= 0.
vec3 roundToHalf(vec3 v) {
  uvec3 bits = floatBitsToUint(v);
  bits += 0xFFFu + ((bits >> 13) & 1u); // half keeps 10 of 23 mantissa bits
  return uintBitsToFloat(bits & 0xFFFFE000u);
}

#endif
