#ifndef PELLUCID_SANITIZE_GLSL
#define PELLUCID_SANITIZE_GLSL

const float kLargestHalf = 65504.0;

// Finite and >= 0. A selection by comparison, because max() may return either operand for NaN. No loops
// over components anywhere: compilers keep dynamically indexed vectors in memory.
vec3 sanitize(vec3 v) {
  return mix(vec3(0.0), min(v, vec3(kLargestHalf)), greaterThan(v, vec3(0.0)));
}

// v rounded to the nearest half, ties up. Image stores may truncate (Vulkan leaves it open), which darkens by up to
// 1e-3 a pass; what is already a half is stored as it is on every device. v >= 0.
vec3 roundToHalf(vec3 v) {
  // Half keeps 10 of 23 mantissa bits.
  return uintBitsToFloat((floatBitsToUint(v) + 0x1000u) & 0xFFFFE000u);
}

#endif
