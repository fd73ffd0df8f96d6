#version 450
// Triangles of the scene, of the camera and of lights.
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 color;
layout(location = 4) in float mark;
layout(location = 5) in vec2 normalUv;
layout(location = 6) in vec4 tangent;
layout(location = 8) in float alpha;

layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec4 outUvs;
layout(location = 2) out vec4 outColorMark;
layout(location = 3) out vec4 outTangent;
layout(location = 4) out float outAlpha;

void main() {
  gl_Position = draw.clipFromWorld * vec4(position, 1.0);
  outNormal = normal;
  outUvs = vec4(uv, normalUv);
  outColorMark = vec4(color, mark);
  outTangent = tangent;
  outAlpha = alpha;
}
