#ifndef PELLUCID_SRGB_GLSL
#define PELLUCID_SRGB_GLSL

// IEC 61966-2-1; clamped to what a display shows.
vec3 srgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

#endif
