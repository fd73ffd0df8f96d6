// Device depth to planar distance, scene units; -1: nothing there.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "steps.glsl"

layout(set = 0, binding = 1) uniform texture2D depthImage;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D planarImage;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isOutside(pixel)) return;
  imageStore(planarImage, pixel, vec4(planarDistance(frame.camera, texelFetch(depthImage, pixel, 0).x)));
}
