// Samples of a pixel from the pixels of an image of twice the size.
#version 450
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef WHOLE_NUMBERS
layout(set = 0, binding = 0) uniform utexture2D source;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2DMS samples;
#else
layout(set = 0, binding = 0) uniform texture2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DMS samples;
#endif
void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(samples)))) return;
  for (int i = 0; i < 4; ++i) imageStore(samples, pixel, i, texelFetch(source, 2 * pixel + ivec2(i & 1, i >> 1), 0));
}
