#version 450
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 color;
layout(location = 4) in float mark;
layout(location = 5) in vec2 normalUv;
layout(location = 6) in vec4 tangent;
layout(location = 7) in vec2 lobeUv;
layout(location = 8) in float alpha;

layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec2 outUv;
layout(location = 2) out vec4 outColorMark;
layout(location = 3) out float outPlanar;
layout(location = 4) out vec2 outNormalUv;
layout(location = 5) out vec4 outTangent;
layout(location = 6) out vec3 outPosition;
layout(location = 7) out vec2 outLobeUv;
layout(location = 8) out float outAlpha;

// Passes compare depths of the same triangle for equality.
invariant gl_Position;

void main() {
  // An engine's normal bias. The axis of an orthographic view of unit length is planar.xyz.
  float offset = (draw.ids.y & IS_OFFSET) != 0u ? uintBitsToFloat(draw.ids.w) * (1.0 + min(dot(draw.planar.xyz, normal), 0.0)) : 0.0;
  vec3 drawn = position - offset * normal;
  gl_Position = draw.clipFromWorld * vec4(drawn, 1.0);
  outNormal = normal;
  outUv = uv;
  outColorMark = vec4(color, mark);
  outPlanar = dot(draw.planar, vec4(drawn, 1.0));
  outNormalUv = normalUv;
  outTangent = tangent;
  outPosition = position;
  outLobeUv = lobeUv;
  outAlpha = alpha;
}
