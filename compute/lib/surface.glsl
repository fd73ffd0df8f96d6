#ifndef PELLUCID_SURFACE_GLSL
#define PELLUCID_SURFACE_GLSL

#include "lib/camera.glsl"

// A pixel's surface. View space, scene units.
struct Surface {
  vec3 position, normal, view; // unit: normal, outward; view, from the eye
  float chord;                 // along the view ray; -1: unknown
  uint material;               // index + 1
};

// R(h) / rho of a slab that transmits t: the part of a half-space's reflectance that is left. `slab`: one of
// GatherConstants::reflectance.
float keptReflectance(vec4 slab, float t) { return clamp(slab.x - sqrt(max(slab.y * t * t + slab.z, 0.0)), 0.0, 1.0); }

// From a pixel of planar distance `front` along an axis of the image to its neighbor that is nearer in depth: the other one may
// lie across an edge. `step`: Camera::rayX or rayY; `direction`: of the pixel's ray; `beside`: distances of the neighbors
// forwards and backwards, <= 0 where there is none.
vec3 alongDepth(vec4 step, vec3 direction, float front, vec2 beside) {
  vec2 apart = mix(vec2(3.0e38), abs(beside - front), greaterThan(beside, vec2(0.0)));
  bool back = apart.y < apart.x;
  float planar = min(apart.x, apart.y) < kNoDepth ? (back ? beside.y : beside.x) : front;
  return (back ? front - planar : planar - front) * direction + vec3(step.zw + planar * step.xy, 0.0);
}

// Unit normal towards the eye of the surface that the depths show; 0 where they show none. `beside`: distances of the pixels
// to the right, to the left, below and above.
vec3 normalOfDepths(Camera camera, ivec2 pixel, float front, vec4 beside) {
  vec3 direction = viewRay(camera, pixel).direction;
  vec3 normal = cross(alongDepth(camera.rayX, direction, front, beside.xy), alongDepth(camera.rayY, direction, front, beside.zw));
  float squared = dot(normal, normal);
  if (!(squared > 0.0)) return vec3(0.0);
  normal *= inversesqrt(squared);
  return dot(normal, direction) > 0.0 ? -normal : normal;
}

#endif
