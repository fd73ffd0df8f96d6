// The least any implementation must move: both depths and the irradiance read once, the output written
// once, 24 bytes a pixel. Every other time is stated as a multiple of this pass.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2D frontDepth;
layout(set = 0, binding = 1) uniform texture2D backDepth;
layout(set = 0, binding = 2) uniform texture2D irradiance;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D result;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(result)))) return;
  float front = texelFetch(frontDepth, pixel, 0).x, back = texelFetch(backDepth, pixel, 0).x;
  // Something that needs every input, so that no read can be left out.
  imageStore(result, pixel, texelFetch(irradiance, pixel, 0) + vec4(back - front));
}
