#version 450
// Depths only: shadow maps of six, and the back faces behind the front.
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 1) in vec2 uv;
layout(location = 3) in float planar;

layout(location = 0) out float outPlanar;
layout(location = 1) out float outDepth;

void main() {
  if (isHole(uv)) discard;
  if (draw.ids.z != 0u) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 front = texelFetch(frontObject, pixel, 0);
    bool sameObject = (draw.ids.z == BEHIND_CASTER ? front.y : front.a) == draw.addedColor.a;
    if (!sameObject || !isNearer(texelFetch(earlierDepth, pixel, 0).r, gl_FragCoord.z)) discard;
  }
  outPlanar = planar;
  outDepth = gl_FragCoord.z;
}
