// Irradiance plus the light that came through in the frame whose history is kept.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"

layout(set = 0, binding = PELLUCID_BINDING_HISTORY) uniform texture2D historyImage;

void main() {
  ivec2 pixel = invocationPixel();
  if (!insideRect(pixel) || materialAt(pixel) == 0u) return;
  vec4 source = texelFetch(sourceImage, inImage(pixel), 0);
  vec3 through = sanitize(texelFetch(historyImage, inImage(pixel), 0).rgb);
  writeResult(pixel, sanitize(source.rgb) + through, source.a, pass.value.z != 0u);
}
