// Conversions from pixel and depth to view space; module/src/camera.h derives the constants from the projection matrix.
#ifndef PELLUCID_CAMERA_GLSL
#define PELLUCID_CAMERA_GLSL

#include "shared/pellucid_shared.h"

// Larger planar distances, and all values <= 0, mean "nothing there".
const float kNoDepth = 1.0e9;

// True of low <= v < high, where low >= 0. Bits say so, because compilers may take for granted that floats are no NaN: they need
// not compile comparisons of floats to be false for NaN. Bits of floats from 0 on have the floats' order; those of negative floats
// and NaN are greater.
bool isWithin(float v, float low, float high) {
  return floatBitsToUint(v) - floatBitsToUint(low) < floatBitsToUint(high) - floatBitsToUint(low);
}

const float kAboveOne = 1.00000012; // the next float
const float kMostFloat = 3.4e38;
// Beyond all lengths and changes of length, and finite: nothing is there.
const float kFarthest = 3.0e38;

// `rect`: [xy, zw).
bool contains(ivec4 rect, ivec2 at) {
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}

struct ViewRay {
  vec3 origin, direction; // direction has planar length 1
};

ViewRay viewRay(Camera camera, vec2 pixel) {
  vec4 r = camera.rayBase + pixel.x * camera.rayX + pixel.y * camera.rayY;
  return ViewRay(vec3(r.zw, 0.0), vec3(r.xy, camera.range.x));
}
ViewRay viewRay(Camera camera, ivec2 pixel) { return viewRay(camera, vec2(pixel)); }

// C d - A of a device depth d; 0 where d is at infinity.
float depthDenominator(Camera camera, float depth) {
  return camera.depth.z * depth - camera.depth.x;
}

// Planar distance of a device depth; -1 where it holds nothing.
float planarDistance(Camera camera, float depth) {
  float denominator = depthDenominator(camera, depth);
  // 0/0 of an infinite far plane stays out.
  bool something = isWithin(depth, 0.0, kAboveOne) && abs(denominator) > 0.0 && depth != camera.range.z;
  float distance = something ? (camera.depth.y - depth * camera.depth.w) / denominator : -1.0;
  // Depths next to an infinite far plane end beyond any scene. Orthographic cameras see surfaces behind the eye.
  return abs(distance) > 0.0 && abs(distance) < kNoDepth ? distance : -1.0;
}

// Planar distance of a viewZ value; -1 where it holds nothing.
float planarDistanceViewZ(float viewZ) {
  return isWithin(viewZ, 0.0, kNoDepth) && viewZ != 0.0 ? viewZ : -1.0;
}

// Finds the pixel that a view-space point falls on; false behind the eye.
bool projectToPixel(Camera camera, vec3 position, out ivec2 pixel) {
  // The function inverts point(p) = origin + p direction, both affine in the pixel: two linear equations.
  float p = position.z * camera.range.x;
  vec2 x = camera.rayX.xy * p + camera.rayX.zw, y = camera.rayY.xy * p + camera.rayY.zw;
  vec2 rest = position.xy - (camera.rayBase.xy * p + camera.rayBase.zw);
  float determinant = x.x * y.y - x.y * y.x;
  pixel = ivec2(0);
  if (!(abs(determinant) > 0.0) || !(p > 0.0)) return false;
  vec2 at = vec2(rest.x * y.y - rest.y * y.x, x.x * rest.y - x.y * rest.x) / determinant;
  // Far outside stays outside after the conversion.
  pixel = ivec2(floor(clamp(at, vec2(-1.0e6), vec2(1.0e6)) + 0.5));
  return true;
}

// Squares of the lengths, scene units, that one pixel step in x and y covers at planar distance p, facing the camera.
vec2 squaredPixelSize(Camera camera, float p) {
  vec2 x = camera.rayX.xy * p + camera.rayX.zw, y = camera.rayY.xy * p + camera.rayY.zw;
  return vec2(dot(x, x), dot(y, y));
}

// These lengths in mm.
vec2 pixelSize(Camera camera, float p) { return sqrt(squaredPixelSize(camera, p)) * camera.range.w; }

// ---- Camera-space thickness: how far the view ray runs inside the object. Scene units; below 0: unknown

// Planar difference of two device depths. Subtracting in depth space first keeps every bit the depth
// buffer has: p1 - p2 = (d1 - d2) (AD - BC) / ((C d1 - A)(C d2 - A)).
float planarDifference(Camera camera, float back, float front) {
  float denominator = depthDenominator(camera, back) * depthDenominator(camera, front);
  // Denominators of two surfaces in front of the eye have one sign; 0 only at infinity.
  return denominator > 0.0 ? (back - front) * camera.range.y / denominator : -1.0;
}

// From planar difference to chord along the ray; a back face that is not behind the front is none.
float chord(float difference, ViewRay ray) {
  return difference > 0.0 && difference < kNoDepth ? difference * length(ray.direction) : -1.0;
}

#endif
