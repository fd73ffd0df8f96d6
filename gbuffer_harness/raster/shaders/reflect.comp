#version 450
// Irradiance times the share of it that surfaces with lobes apart reflect.

layout(local_size_x = 8, local_size_y = 8) in; // kGroup of common/pixel_pass.cpp

layout(set = 0, binding = 0, rgba32f) uniform image2D irradiance;
layout(set = 0, binding = 1) uniform sampler2D share; // of reflected.frag

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(irradiance)))) return;
  vec3 e = imageLoad(irradiance, pixel).rgb * texelFetch(share, pixel, 0).rgb;
  imageStore(irradiance, pixel, vec4(e, 0.0));
}
