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

// From a pixel of distance `front` to its neighbor that is nearer in depth: the other one may lie across an edge. `step`: one
// pixel along an axis; `beside`: distances of the neighbors that way and the other way, <= 0 where there is none.
vec3 alongDepth(Camera camera, ivec2 pixel, float front, ivec2 step, vec2 beside) {
  vec2 apart = mix(vec2(3.0e38), abs(beside - front), greaterThan(beside, vec2(0.0)));
  bool back = apart.y < apart.x;
  float planar = min(apart.x, apart.y) < kNoDepth ? (back ? beside.y : beside.x) : front;
  ViewRay own = viewRay(camera, pixel), other = viewRay(camera, back ? pixel - step : pixel + step);
  vec3 to = other.origin - own.origin + planar * other.direction - front * own.direction;
  return back ? -to : to;
}

// Unit normal towards the eye of the surface that the depths show; 0 where they show none. `beside`: distances of the pixels
// to the right, to the left, below and above.
vec3 normalOfDepths(Camera camera, ivec2 pixel, float front, vec4 beside) {
  vec3 normal = cross(alongDepth(camera, pixel, front, ivec2(1, 0), beside.xy),
                      alongDepth(camera, pixel, front, ivec2(0, 1), beside.zw));
  float squared = dot(normal, normal);
  if (!(squared > 0.0)) return vec3(0.0);
  normal *= inversesqrt(squared);
  return dot(normal, viewRay(camera, pixel).direction) > 0.0 ? -normal : normal;
}

#endif
