// Level 1 of the pyramid from a tile of pixels that a group has in shared memory. An invocation does four pixels and then
// a texel.
#ifndef PELLUCID_QUAD_TILE_GLSL
#define PELLUCID_QUAD_TILE_GLSL

#include "passes/pyramid.glsl"

const int kTile = 2 * GROUP_SIDE; // pixels
shared uvec2 tileColors[kTile * kTile]; // and material
shared float tileDepths[kTile * kTile];

// `color`: of halves.
void keepPixel(ivec2 inTile, vec3 color, float depth, uint material) {
  tileColors[inTile.y * kTile + inTile.x] = packHalves(color, material);
  tileDepths[inTile.y * kTile + inTile.x] = depth;
}

// After a barrier.
void writeQuad() {
  ivec2 local = ivec2(gl_LocalInvocationID.xy), quad = (evenTile() >> 1) + local;
  uint material[4];
  float depth[4];
  vec3 color[4];
  for (int i = 0; i < 4; ++i) {
    int at = (2 * local.y + (i >> 1)) * kTile + 2 * local.x + (i & 1);
    uvec2 packed = tileColors[at];
    material[i] = packed.y >> 16;
    depth[i] = tileDepths[at];
    color[i] = unpackColor(packed);
  }
  if (insideLevel(levelRect(1u), quad)) writeLevel(1u, quad, quadTexel(material, depth, color));
}

#endif
