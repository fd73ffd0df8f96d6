#ifndef PELLUCID_SANITIZE_GLSL
#define PELLUCID_SANITIZE_GLSL

const float kLargestHalf = 65504.0;

// Finite and >= 0. Bits say what is above 0 and no NaN, because compilers may take for granted that floats are none. No
// function loops over components: compilers keep dynamically indexed vectors in memory.
vec3 sanitize(vec3 v) {
  const uint kInfinity = 0x7F800000u;
  return mix(vec3(0.0), min(v, vec3(kLargestHalf)), lessThan(floatBitsToUint(v) - 1u, uvec3(kInfinity)));
}

// v rounded to the nearest half, ties up; v >= 0. Image stores may truncate (Vulkan leaves it open), which darkens by up
// to 1e-3 a pass. Every device stores a half as it is.
vec3 roundToHalf(vec3 v) {
  return uintBitsToFloat((floatBitsToUint(v) + 0x1000u) & 0xFFFFE000u); // halves keep 10 of 23 mantissa bits
}

#endif
