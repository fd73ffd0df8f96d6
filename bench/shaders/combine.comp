// Irradiance plus the light that came through.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "steps.glsl"

layout(set = 0, binding = 1) uniform texture2D irradianceImage;
layout(set = 0, binding = 2) uniform texture2D transmittedImage;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D resultImage;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isOutside(pixel)) return;
  imageStore(resultImage, pixel, texelFetch(irradianceImage, pixel, 0) + texelFetch(transmittedImage, pixel, 0));
}
