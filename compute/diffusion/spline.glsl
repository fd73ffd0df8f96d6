#ifndef PELLUCID_SPLINE_GLSL
#define PELLUCID_SPLINE_GLSL

// The quadratic B-spline at -1, 0 and 1 for a point at most half a texel from 0.
vec3 spline(float at) {
  return vec3(0.5 * (0.5 - at) * (0.5 - at), 0.75 - at * at, 0.5 * (0.5 + at) * (0.5 + at));
}

// The spline at a pixel of a texel of level 2, in one direction.
vec3 splineAt(int pixel) { return spline(0.25 * (float(pixel & 3) - 1.5)); }

#endif
