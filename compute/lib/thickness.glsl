// Camera-space thickness: how far the view ray runs inside the object. Scene units; -1: unknown.
#ifndef PELLUCID_THICKNESS_GLSL
#define PELLUCID_THICKNESS_GLSL

#include "lib/camera.glsl"

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
