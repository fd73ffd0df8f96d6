#version 450
// Shadow maps and the back faces' depth: holes are all that a texture says.
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = 1) uniform sampler2D baseColorTexture;

layout(location = 1) in vec4 uvs;
layout(location = 4) in float alpha;

void main() {
  if (texture(baseColorTexture, uvs.xy).a * alpha < draw.baseColor.a) discard;
}
