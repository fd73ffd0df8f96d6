// Front and back planar distance to the chord of the view ray, scene units; -1: unknown.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "steps.glsl"
#include "lib/camera.glsl"

layout(set = 0, binding = 1) uniform texture2D frontImage;
layout(set = 0, binding = 2) uniform texture2D backImage;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D thicknessImage;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isOutside(pixel)) return;
  float front = texelFetch(frontImage, pixel, 0).x, back = texelFetch(backImage, pixel, 0).x;
  float through = front > 0.0 && back > 0.0 ? chord(back - front, viewRay(frame.camera, pixel)) : -1.0;
  imageStore(thicknessImage, pixel, vec4(through));
}
