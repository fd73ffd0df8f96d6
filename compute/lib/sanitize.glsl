#ifndef PELLUCID_SANITIZE_GLSL
#define PELLUCID_SANITIZE_GLSL

const float kLargestHalf = 65504.0;

// Finite and >= 0. mix() selects by comparison, because max() may return either operand for NaN. No function loops over
// components: compilers keep dynamically indexed vectors in memory.
vec3 sanitize(vec3 v) {
  return mix(vec3(0.0), min(v, vec3(kLargestHalf)), greaterThan(v, vec3(0.0)));
}

// v rounded to the nearest half, ties up; v >= 0. Image stores may truncate (Vulkan leaves it open), which darkens by up
// to 1e-3 a pass. Every device stores a half as it is.
vec3 roundToHalf(vec3 v) {
  return uintBitsToFloat((floatBitsToUint(v) + 0x1000u) & 0xFFFFE000u); // halves keep 10 of 23 mantissa bits
}

#endif
