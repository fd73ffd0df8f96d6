#ifndef PELLUCID_SURFACE_GLSL
#define PELLUCID_SURFACE_GLSL

#include "lib/camera.glsl"

// A pixel's surface. View space, scene units.
struct Surface {
  vec3 position, normal, view; // unit: normal, outward; view, from the eye
  float chord;                 // along the view ray, or the stored thickness; below 0: unknown
  uint material;               // index + 1
};

// R(h) / rho of a slab that transmits t: the part of a half-space's reflectance that is left. `slab`: one of
// GatherConstants::reflectance.
float keptReflectance(vec4 slab, float t) { return clamp(slab.x - sqrt(max(slab.y * t * t + slab.z, 0.0)), 0.0, 1.0); }

// ---- The nearer of two neighbors along an axis, as the other one may lie across an edge

// Change of depth along the axis: the lesser of the changes to the neighbors forwards and backwards, each per step forwards. A change of
// kFarthest stands for a missing neighbor; where both are missing, the result is 0.
float nearerStep(float forwards, float backwards) {
  float step = abs(backwards) < abs(forwards) ? backwards : forwards;
  return abs(step) < kFarthest ? step : 0.0;
}

// The same choice between changes of position; w: 1, or 0 without a neighbor. Two changes of like length count alike, as on curved
// surfaces: a choice between them would follow rounding.
vec3 nearerStep(vec4 forwards, vec4 backwards) {
  float f = dot(forwards.xyz, forwards.xyz), b = dot(backwards.xyz, backwards.xyz);
  if (forwards.w == 0.0 || backwards.w == 0.0) return forwards.w * forwards.xyz + backwards.w * backwards.xyz;
  float ratio = min(f, b) / max(max(f, b), 1.0e-30), far = ratio * ratio / (1.0 + ratio * ratio);
  return b < f ? mix(backwards.xyz, forwards.xyz, far) : mix(forwards.xyz, backwards.xyz, far);
}

// Step along an axis of the image on the surface of a pixel of planar distance `front`; where no neighbor says, that of a facing
// surface. `step`: Camera::rayX or rayY; `direction`: of the pixel's ray; `beside`: distances of the neighbors forwards and
// backwards, <= 0 where there is none.
vec3 alongDepth(vec4 step, vec3 direction, float front, vec2 beside) {
  bvec2 there = greaterThan(beside, vec2(0.0));
  if (!any(there)) return vec3(step.zw + front * step.xy, 0.0);
  vec3 forwards = (beside.x - front) * direction + vec3(step.zw + beside.x * step.xy, 0.0);
  vec3 backwards = (front - beside.y) * direction + vec3(step.zw + beside.y * step.xy, 0.0);
  return nearerStep(vec4(forwards, there.x ? 1.0 : 0.0), vec4(backwards, there.y ? 1.0 : 0.0));
}

// Unit normal towards the eye of the surface that the depths show; 0 where they show none. `beside`: distances of the pixels
// to the right, to the left, below and above.
vec3 normalOfDepths(Camera camera, ivec2 pixel, float front, vec4 beside) {
  vec3 direction = viewRay(camera, pixel).direction;
  vec3 a = alongDepth(camera.rayX, direction, front, beside.xy), b = alongDepth(camera.rayY, direction, front, beside.zw);
  // In steps of about 1, whose products keep within floats in any unit.
  vec3 most = max(abs(a), abs(b));
  float scale = 1.0 / max(max(most.x, max(most.y, most.z)), 1.0e-30);
  vec3 normal = cross(scale * a, scale * b);
  float squared = dot(normal, normal);
  if (!(squared > 0.0)) return vec3(0.0);
  normal *= inversesqrt(squared);
  return dot(normal, direction) > 0.0 ? -normal : normal;
}

#endif
