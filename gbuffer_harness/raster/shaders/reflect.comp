#version 450
// Irradiance times the share of it that surfaces with lobes apart reflect.
#extension GL_GOOGLE_include_directive : require
#include "shared/pellucid_shared.h"

layout(local_size_x = PELLUCID_GROUP_X, local_size_y = PELLUCID_GROUP_Y) in;

layout(set = 0, binding = 0, rgba32f) uniform image2D irradiance;
layout(set = 0, binding = 1) uniform sampler2D share; // of reflected.frag

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(irradiance)))) return;
  vec3 e = imageLoad(irradiance, pixel).rgb * texelFetch(share, pixel, 0).rgb;
  imageStore(irradiance, pixel, vec4(e, 0.0));
}
