// The light that comes through, over rho. THICKNESS: the chord comes from an image, else from both planar
// distances here. One shadow image.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame/gbuffer_decode.glsl"
#include "lib/surface.glsl"
#include "steps.glsl"

layout(push_constant) uniform Pass { uvec4 value; } pass; // x: lights
layout(set = 0, binding = 1) readonly buffer Lights { LightConstants lights[]; };
layout(set = 0, binding = 2) readonly buffer Shadows { ShadowConstants shadows[]; };
layout(set = 0, binding = 3) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = 4) uniform texture2D frontImage;
layout(set = 0, binding = 5) uniform texture2D thicknessOrBackImage;
layout(set = 0, binding = 6) uniform utexture2D materialImage;
layout(set = 0, binding = 7) uniform texture2D shadowImage;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D transmittedImage;

float shadowTexel(uint image, ivec2 texel) { return texelFetch(shadowImage, texel, 0).x; }
vec4 shadowTexels(uint image, ivec2 a, ivec2 b, ivec2 c, ivec2 d) {
  return vec4(shadowTexel(image, a), shadowTexel(image, b), shadowTexel(image, c), shadowTexel(image, d));
}
float distanceOf(ivec2 pixel, uint material, bool back) {
  if (!contains(ivec4(frame.rect), pixel) || decodeMaterial(texelFetch(materialImage, pixel, 0)) != material) return -1.0;
  float front = texelFetch(frontImage, pixel, 0).x;
  if (!back) return front;
  float through = texelFetch(thicknessOrBackImage, pixel, 0).x;
#ifdef THICKNESS
  through = through > 0.0 ? front + through / length(viewRay(frame.camera, pixel).direction) : -1.0;
#endif
  return through;
}

// The frames have none.
vec3 hiddenIrradianceOf(ivec2 pixel) { return vec3(0.0); }

#define PELLUCID_OWN_INPUTS
#include "translucency/transmission.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isOutside(pixel)) return;
  uint material = decodeMaterial(texelFetch(materialImage, pixel, 0));
  vec3 sum = vec3(0.0);
  float front = texelFetch(frontImage, pixel, 0).x;
  if (material != 0u && front > 0.0) {
    ViewRay ray = viewRay(frame.camera, pixel);
    float through = texelFetch(thicknessOrBackImage, pixel, 0).x;
#ifndef THICKNESS
    through = through > 0.0 ? chord(through - front, ray) : -1.0;
#endif
    Surface s = surfaceOf(pixel, ray, front, through, material);
    for (uint i = 0u; i < pass.value.x; ++i)
      sum += exitanceOf(lightTransmission(lights[i], s, pixel), material - 1u);
    sum *= materials[material - 1u].inverseReflectance.rgb;
  }
  imageStore(transmittedImage, pixel, vec4(sum, 1.0));
}
