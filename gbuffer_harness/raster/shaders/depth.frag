#version 450
// Depths only: shadow maps of six, and the back faces behind the front.
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 1) in vec2 uv;
layout(location = 3) in float planar;
layout(location = 8) in float alpha;

layout(location = 0) out float outPlanar;
layout(location = 1) out float outDepth;

// Front and back face meet where a silhouette's edge runs through the pixel's center. Rounding may put the back face
// in front, by no more than its depth changes within the pixel.
bool isBehind(float depth, float slope, float front) {
  float nearest = (draw.ids.y & 1u) != 0u ? depth - slope : depth + slope;
  return !isNearer(nearest, front);
}

void main() {
  float slope = fwidth(gl_FragCoord.z);
  if (isHole(uv, alpha)) discard;
  if (behindWhat() != 0u) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 front = texelFetch(frontObject, pixel, 0);
    bool sameObject = (behindWhat() == BEHIND_CASTER ? front.r : front.a) == draw.addedColor.a;
    // Light's way through a body also ends at what is opaque, whatever object it is.
    if (behindWhat() == BEHIND_CASTER && front.r >= 0.0 && partMaterial() == 0u) sameObject = true;
    float frontDepth = texelFetch(earlierDepth, pixel, 0).r;
    bool behind = behindWhat() == BEHIND_CASTER ? isNearer(frontDepth, gl_FragCoord.z)
                                              : isBehind(gl_FragCoord.z, slope, frontDepth);
    if (!sameObject || !behind) discard;
  }
  outPlanar = planar;
  outDepth = gl_FragCoord.z;
}
