// The front and back surfaces that a frame's depths hold.
#ifndef PELLUCID_SURFACE_IMAGES_GLSL
#define PELLUCID_SURFACE_IMAGES_GLSL

#include "frame/frame.glsl"

layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;

// As translucency/transmission.glsl says.
float distanceOf(ivec2 pixel, uint material, bool back) {
  ivec2 at = inImage(withinRect(inLattice(pixel)));
  uint there = materialAt(at); // no load waits for another
  float planar = back ? backDistanceOf(texelFetch(backDepthImage, at, 0).x) : frontDistance(at);
  return at == pixel && there == material ? planar : -1.0;
}

#include "lib/facet.glsl"

#endif
