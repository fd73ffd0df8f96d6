#version 450
// An image in halves that are the bits of an upload, which rounds a half's half up; devices round as they like.

layout(local_size_x = 8, local_size_y = 8) in; // kGroup of common/pixel_pass.cpp

layout(set = 0, binding = 0) uniform sampler2D from;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2D to;

// glm::packHalf1x16, as the float of the same value.
float halfOf(float value) {
  uint bits = floatBitsToUint(value), sign = (bits >> 16) & 0x8000u, m = bits & 0x7FFFFFu;
  int e = int((bits >> 23) & 0xFFu) - 112;
  uint rounded;
  if (e < -10) rounded = 0u;
  else if (e <= 0) {
    m = (m | 0x800000u) >> (1 - e);
    rounded = (m + ((m & 0x1000u) << 1)) >> 13;
  } else if (e == 143) rounded = 0x7C00u | (m == 0u ? 0u : max(m >> 13, 1u));
  else rounded = min((uint(e) << 10) + ((m + ((m & 0x1000u) << 1)) >> 13), 0x7C00u);
  return unpackHalf2x16(sign | rounded).x;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(to)))) return;
  vec3 value = texelFetch(from, pixel, 0).rgb;
  imageStore(to, pixel, vec4(halfOf(value.r), halfOf(value.g), halfOf(value.b), 1.0));
}
