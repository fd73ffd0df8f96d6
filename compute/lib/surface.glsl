#ifndef PELLUCID_SURFACE_GLSL
#define PELLUCID_SURFACE_GLSL

#include "lib/camera.glsl"

// A pixel's surface. View space, scene units.
struct Surface {
  vec3 position, normal, view; // view: unit, from the eye
  float chord;                 // along the view ray; -1: unknown
  bool hasNormal;
  uint material; // index + 1; 0: not known
};

// `normal`: any length, view space; (0, 0, 0): none.
Surface makeSurface(ViewRay ray, float planar, float chord, vec3 normal) {
  float squared = dot(normal, normal);
  bool hasNormal = squared > 1.0e-8 && squared < 1.0e8; // false for NaN
  if (hasNormal) normal *= inversesqrt(squared);
  return Surface(ray.origin + planar * ray.direction, normal, normalize(ray.direction), chord, hasNormal, 0u);
}

#endif
