// Normals of the frame, where it has an image of them.
#ifndef PELLUCID_NORMAL_IMAGE_GLSL
#define PELLUCID_NORMAL_IMAGE_GLSL

#include "frame/bindings.glsl"

layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;

// Outward normal of any length, in the image's space; 0: none.
vec3 normalAt(ivec2 pixel) {
  return hasFlag(PELLUCID_FLAG_NORMAL) ? decodeNormal(texelFetch(normalImage, pixel, 0)) : vec3(0.0);
}

#endif
