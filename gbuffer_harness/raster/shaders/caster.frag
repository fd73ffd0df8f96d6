#version 450
// A shadow map's surface, and what casts the shadow.
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colorMark;
layout(location = 3) in float planar;
layout(location = 8) in float alpha;

layout(location = 0) out float outPlanar;
layout(location = 1) out float outDepth;
layout(location = 2) out float outObject;   // -1: seen from within, so that it has no exit
layout(location = 3) out float outMaterial; // index / 255

void main() {
  if (isHole(uv, alpha)) discard;
  outPlanar = planar;
  outDepth = gl_FragCoord.z;
  outObject = gl_FrontFacing ? draw.addedColor.a : -1.0;
  outMaterial = float(colorMark.a >= 0.5 ? partMaterial() : 0u) / 255.0;
}
