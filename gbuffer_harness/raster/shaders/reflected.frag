#version 450
// The nearest surface again: what its irradiance is times where its two lobes are apart.
#extension GL_GOOGLE_include_directive : require
#include "lobes.glsl"

layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colorMark;
layout(location = 7) in vec2 lobeUv;
layout(location = 8) in float alpha;

layout(location = 0) out vec4 outShare;

void main() {
  vec3 share = reflectedShare(lobesOf(uv, lobeUv, colorMark.rgb));
  if (isHole(uv, alpha)) discard; // after the derivatives
  outShare = vec4(share, 1.0);
}
