// Lights, materials and what a pixel's surface is to them: the bindings of passes that transmit light.
#ifndef PELLUCID_LIT_SURFACE_GLSL
#define PELLUCID_LIT_SURFACE_GLSL

#include "frame/bindings.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(set = 0, binding = PELLUCID_BINDING_SHADOWS) uniform Shadows { ShadowConstants shadows[PELLUCID_DISPATCH_SHADOWS]; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;
#include "frame/chord.glsl"
#include "frame/normal_image.glsl"
#include "frame/shadow_images.glsl"
#include "lib/surface.glsl"

float distanceOf(ivec2 pixel, uint material, bool back) {
  if (!insideRect(pixel) || materialAt(pixel) != material) return -1.0;
  return back ? backDistanceOf(texelFetch(backDepthImage, pixel, 0).x) : frontDistance(pixel);
}

#include "translucency/transmission.glsl"
#include "translucency/ambient.glsl"

Surface surfaceAt(ivec2 pixel, float front, float frontStored, float backStored, vec4 normalTexel) {
  ViewRay ray = viewRay(frame.camera, pixel);
  float along = -1.0;
  if (hasFlag(PELLUCID_FLAG_CHORD) && hasFlag(PELLUCID_FLAG_BACK_DEPTH)) along = chordOf(ray, front, frontStored, backStored);
  vec3 normal = vec3(0.0);
  if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
  return makeSurface(ray, front, along, normal);
}

#endif
