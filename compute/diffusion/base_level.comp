// Makes the base level of the diffusion pyramid, level 1, from the pixels, and copies these where the plan asks for it.
#version 460
#extension GL_GOOGLE_include_directive : require

#define FOUR_PIXELS
#include "frame/tile.glsl"
#include "frame/normal_image.glsl"
#include "diffusion/pyramid.glsl"
#include "diffusion/quad.glsl"

const int kTile = TILE_SIDE, kQuads = kTile / 2; // of a row
shared uvec2 tileColors[kTile * kTile]; // colors and materials, by packHalves
shared float tileDepths[kTile * kTile];

void main() {
  // The first invocations do a quad each.
  bool hasQuad = gl_LocalInvocationIndex < uint(kQuads * kQuads);
  ivec2 local = ivec2(gl_LocalInvocationIndex % uint(kQuads), gl_LocalInvocationIndex / uint(kQuads));
  ivec2 tile = evenTile(), quad = (tile >> 1) + local;
  uint material[kPixels];
  float depth[kPixels];
  vec4 source[kPixels];
  // All loads come before the first use, so that their latencies overlap.
  vec3 normal = hasQuad ? normalAt(withinRect(pixelOfQuad(quad))) : vec3(0.0);
  for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = tile + pixelInTile(i), at = withinRect(pixel);
    material[i] = at == pixel ? materialAt(at) : 0u;
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  for (int i = 0; i < kPixels; ++i) {
    vec3 color = sanitize(source[i].rgb);
    ivec2 inTile = pixelInTile(i);
    if (pass.value.x != 0u && material[i] != 0u)
      imageStore(destinationImage, tile + inTile, vec4(asStored(color), source[i].a));
    tileColors[inTile.y * kTile + inTile.x] = packHalves(roundToHalf(color), material[i]);
    tileDepths[inTile.y * kTile + inTile.x] = depth[i];
  }
  barrier();
  if (!hasQuad || !contains(levelRect(1u), quad)) return;
  float depths[4];
  uvec2 packed[4];
  for (int i = 0; i < 4; ++i) {
    int at = (2 * local.y + (i >> 1)) * kTile + 2 * local.x + (i & 1);
    packed[i] = tileColors[at];
    depths[i] = tileDepths[at];
  }
  writeLevel(1u, quad, texelOfQuad(quad, packed, depths, normal));
}
