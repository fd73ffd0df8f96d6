// Surfaces of pixels in space.
#ifndef PELLUCID_SURFACES_GLSL
#define PELLUCID_SURFACES_GLSL

#include "passes/bindings.glsl"
#include "lib/pyramid.glsl"

// A point of the view ray, mm; z: planar distance.
vec3 pointAt(vec2 pixel, float p) {
  vec4 ray = frame.camera.rayBase + pixel.x * frame.camera.rayX + pixel.y * frame.camera.rayY;
  return vec3(ray.zw + p * ray.xy, p) * frame.camera.range.w;
}

// Facing the camera, mm^2.
float pixelArea(float p) {
  vec2 size = pixelSize(frame.camera, p);
  return size.x * size.y;
}

// Of a surface with that normal: xy: slope, as of texels; z: area over that of one facing the camera.
vec3 tilt(vec2 pixel, vec3 normal) {
  vec3 n = mat3(frame.viewFromNormal) * normal;
  float squared = dot(n, n);
  if (!(squared > 1.0e-8)) return vec3(0.0, 0.0, 1.0); // it has none
  n *= inversesqrt(squared);
  vec4 ray = frame.camera.rayBase + pixel.x * frame.camera.rayX + pixel.y * frame.camera.rayY;
  vec2 column = frame.camera.rayX.xy + frame.camera.rayX.zw, row = frame.camera.rayY.xy + frame.camera.rayY.zw;
  float inverse = 1.0 / max(-dot(n, vec3(ray.xy, frame.camera.range.x)), kLeastCosine);
  return vec3(dot(n.xy, column) * inversesqrt(max(dot(column, column), 1.0e-30)),
              dot(n.xy, row) * inversesqrt(max(dot(row, row), 1.0e-30)), 1.0) * inverse;
}

#endif
