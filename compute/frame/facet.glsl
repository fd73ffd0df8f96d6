// The facet of a pixel: what the depths around it say of its surface. PELLUCID_OWN_INPUTS as in translucency/transmission.glsl.
// Includers require GL_EXT_control_flow_attributes.
#ifndef PELLUCID_FACET_GLSL
#define PELLUCID_FACET_GLSL

#include "lib/surface.glsl"

#ifndef PELLUCID_OWN_INPUTS
#include "frame/frame.glsl"

layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;

// As translucency/transmission.glsl says. `pixel`, here and below: of the image, not of the lattice.
float distanceOf(ivec2 pixel, uint material, bool back) {
  ivec2 at = inImage(withinRect(inLattice(pixel)));
  uint there = materialAt(at); // no load waits for another
  float planar = back ? backDistanceOf(texelFetch(backDepthImage, at, 0).x) : frontDistance(at);
  return at == pixel && there == material ? planar : -1.0;
}
#endif

// Unrolled, the loads of the four neighbors overlap. transmission.glsl has no registers for that, and defines another loop.
#ifndef FACET_LOOP
#define FACET_LOOP [[unroll]]
#endif

// The i-th of the four pixels beside a pixel: right, left, below, above.
ivec2 pixelBeside(ivec2 pixel, int i) {
  int side = 1 - 2 * (i & 1);
  return pixel + (i < 2 ? ivec2(side, 0) : ivec2(0, side));
}

// Unit normal of the front or back depths, towards the eye; 0: not known. `own`: the pixel's planar distance in
// these depths, above 0.
vec3 facetAt(ivec2 pixel, uint material, float own, bool back) {
  vec4 beside;
  FACET_LOOP for (int i = 0; i < 4; ++i) beside[i] = distanceOf(pixelBeside(pixel, i), material, back);
  if (!all(greaterThan(beside, vec4(0.0)))) {
    // Single pixels of hair lie between pixels of the surface.
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
      if (beside[i] > 0.0) continue;
      float beyond = distanceOf(pixelBeside(pixelBeside(pixel, i), i), material, back);
      if (beyond > 0.0) beside[i] = mix(own, beyond, 0.5);
    }
  }
  return normalOfDepths(frame.camera, inLattice(pixel), own, beside);
}

#endif
