// Level 1 of the diffusion pyramid, where no pass before makes it beside its own result. An invocation does 2 x 2
// pixels.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "passes/pyramid.glsl"

void main() {
  ivec4 rect = levelRect(1u);
  ivec2 quad = rect.xy + ivec2(gl_GlobalInvocationID.xy);
  if (!insideLevel(rect, quad)) return;
  uint material[4];
  float depth[4];
  vec4 source[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * quad + ivec2(i & 1, i >> 1);
    ivec2 at = clamp(pixel, ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1);
    material[i] = at == pixel ? materialAt(at) : 0u;
  }
  if ((material[0] | material[1] | material[2] | material[3]) == 0u) {
    writeLevel(1u, quad, uvec4(0u));
    return;
  }
  // The rest at once, so that the latencies overlap.
  for (int i = 0; i < 4; ++i) {
    ivec2 at = clamp(2 * quad + ivec2(i & 1, i >> 1), ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1);
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  vec3 color[4];
  for (int i = 0; i < 4; ++i) {
    color[i] = sanitize(source[i].rgb);
#ifdef COPY
    color[i] = asStored(color[i]);
    if (material[i] != 0u)
      imageStore(destinationImage, 2 * quad + ivec2(i & 1, i >> 1), vec4(color[i], source[i].a));
#endif
  }
  writeLevel(1u, quad, quadTexel(material, depth, color));
}
