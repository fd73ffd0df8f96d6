#version 450
// Triangles of the scene, of the camera and of lights.
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec3 color;

layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec3 outColor;

void main() {
  gl_Position = draw.clipFromWorld * vec4(position, 1.0);
  outNormal = normal;
  outColor = color;
}
