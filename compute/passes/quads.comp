// Level 1 of the diffusion pyramid, where no pass before makes it beside its own result.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define FOUR_PIXELS
#include "passes/quad_tile.glsl"

void main() {
  uint material[kPixels];
  float depth[kPixels];
  vec4 source[kPixels];
  vec3 normal = normalOfQuad();
  // All at once, so that the latencies overlap.
  for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = evenTile() + pixelInTile(i);
    ivec2 at = withinRect(pixel);
    material[i] = at == pixel ? materialAt(at) : 0u;
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  for (int i = 0; i < kPixels; ++i) {
    vec3 color = sanitize(source[i].rgb);
    // The last pass filters planes without sanitizing: what would need it is none.
    uint apart = any(notEqual(color, source[i].rgb)) ? apartFromQuad() : 0u;
#ifdef COPY
    color = asStored(color);
    if (material[i] != 0u) imageStore(destinationImage, evenTile() + pixelInTile(i), vec4(color, source[i].a));
#endif
    keepPixel(pixelInTile(i), roundToHalf(color), depth[i], material[i] | apart);
  }
  barrier();
  writeQuad(normal);
}
