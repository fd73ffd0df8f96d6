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

// True where a vector of that squared length has a direction; false for NaN.
bool hasDirection(float squared) { return squared > 1.0e-8 && squared < 1.0e8; }

// `normal`: any length, view space; (0, 0, 0): none.
Surface makeSurface(ViewRay ray, float planar, float chord, vec3 normal) {
  Surface s;
  s.position = ray.origin + planar * ray.direction;
  s.view = normalize(ray.direction);
  s.chord = chord;
  s.material = 0u;
  s.normal = normal;
  float squared = dot(s.normal, s.normal);
  s.hasNormal = hasDirection(squared);
  if (s.hasNormal) s.normal *= inversesqrt(squared);
  return s;
}

#endif
