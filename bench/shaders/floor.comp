// The least any implementation must move: both depths and the irradiance read once, the output written
// once, 24 bytes a pixel. Every other time is stated as a multiple of this pass.
#version 460
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const int kPixels = 1; // of a thread, one group's width apart

layout(set = 0, binding = 0) uniform texture2D frontDepth;
layout(set = 0, binding = 1) uniform texture2D backDepth;
layout(set = 0, binding = 2) uniform texture2D irradiance;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D result;

void main() {
  ivec2 group = ivec2(gl_WorkGroupSize.xy);
  ivec2 first = ivec2(gl_WorkGroupID.xy) * group * ivec2(kPixels, 1) + ivec2(gl_LocalInvocationID.xy);
  for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = first + ivec2(i * group.x, 0);
    if (any(greaterThanEqual(pixel, imageSize(result)))) return;
    float front = texelFetch(frontDepth, pixel, 0).x, back = texelFetch(backDepth, pixel, 0).x;
    // Something that needs every input, so that no read can be left out.
    imageStore(result, pixel, texelFetch(irradiance, pixel, 0) + vec4(back - front));
  }
}
