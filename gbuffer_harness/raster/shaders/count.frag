#version 450
// Adds up the faces of the front's object along each view ray, +1 for front and -1 for back faces. A
// closed surface gives 0; a ray through a hole does not.
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 1) in vec2 uv;
layout(location = 8) in float alpha;

layout(location = 0) out vec2 outCount; // x: all faces; y: those nearer than the back face

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (isHole(uv, alpha) || texelFetch(frontObject, pixel, 0).a != draw.addedColor.a) discard;
  float face = gl_FrontFacing ? 1.0 : -1.0;
  bool beforeBack = isNearer(gl_FragCoord.z, texelFetch(earlierDepth, pixel, 0).r);
  outCount = vec2(face, beforeBack ? face : 0.0);
}
