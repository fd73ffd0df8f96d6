// Adds gathered light to the pixels, which take what the four probes around them have, and the light of lights without
// shadow maps.
#version 460
#extension GL_GOOGLE_include_directive : require

#define FOUR_PIXELS // their loads overlap
#define TILE_SIDE (2 * PELLUCID_GATHER_GROUP)
#include "frame/tile.glsl"
#include "gather/tile_probes.glsl"
#include "translucency/lit_surface.glsl"
#include "gather/lit_pixel.glsl"

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec2 tile = tileStart();
  uint value[kPixels];
  vec4 source[kPixels];
  float front[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = withinRect(tile + pixelInTile(i));
    value[i] = materialValueAt(pixel);
    source[i] = texelFetch(sourceImage, pixel, 0);
    front[i] = texelFetch(frontDepthImage, pixel, 0).x;
  }
  if (index == 0) someLight = 0u;
  barrier();
  uint light = side == 1 ? 0u : loadProbes(index, side); // each pixel reads its own probe where side is 1
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (someLight != 0u) unpackProbes(index, side);
  barrier();
  if (pass.value.w == pass.value.y) {
    // The loop is unrolled, so that the arrays stay in registers.
    [[unroll]] for (int i = 0; i < kPixels; ++i) {
      ivec2 pixel = tile + pixelInTile(i);
      if (insideRect(pixel)) writePixel(pixel, side, value[i], source[i], front[i], false);
    }
  } else {
    // The loop is not unrolled, so that the code of other lights is there once.
    [[dont_unroll]] for (int i = 0; i < kPixels; ++i) {
      ivec2 pixel = tile + pixelInTile(i);
      if (insideRect(pixel))
        writePixel(pixel, side, materialValueAt(pixel), texelFetch(sourceImage, pixel, 0),
                   texelFetch(frontDepthImage, pixel, 0).x, true);
    }
  }
}
