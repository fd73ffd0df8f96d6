// Irradiance plus the light that came through in the frame whose history is kept.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"

layout(push_constant) uniform Pass { AddHistoryPass pass; };
layout(set = 0, binding = PELLUCID_BINDING_HISTORY) uniform texture2D historyImage;

void main() {
  ivec2 at = invocationPlace();
  if (!insideRect(inLattice(at)) || materialAt(at) == 0u) return;
  vec4 source = texelFetch(sourceImage, at, 0);
  vec3 through = change(texelFetch(historyImage, at, 0).rgb);
  writeResult(at, sanitize(source.rgb) + through, source.a, pass.last != 0u);
}
