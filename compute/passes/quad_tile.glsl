// Level 1 of the pyramid from a tile of pixels that a group has in shared memory. An invocation does four pixels and then
// a texel.
#ifndef PELLUCID_QUAD_TILE_GLSL
#define PELLUCID_QUAD_TILE_GLSL

#include "passes/normal_image.glsl"
#include "passes/pyramid.glsl"

const int kTile = 2 * GROUP_SIDE; // pixels
shared uvec2 tileColors[kTile * kTile]; // and material
shared float tileDepths[kTile * kTile];

// `color`: of halves.
void keepPixel(ivec2 inTile, vec3 color, float depth, uint material) {
  tileColors[inTile.y * kTile + inTile.x] = packHalves(color, material);
  tileDepths[inTile.y * kTile + inTile.x] = depth;
}

ivec2 ownQuad() { return (evenTile() >> 1) + ivec2(gl_LocalInvocationID.xy); }

// The pixel whose normal stands for a quad that is one surface: any of the four, by turns.
ivec2 pixelOfQuad(ivec2 quad) { return 2 * quad + (quad.yx & 1); }

// Of the invocation's quad, to be loaded with all the rest.
vec3 normalOfQuad() {
  return normalAt(withinRect(pixelOfQuad(ownQuad())));
}

// After a barrier. `normal`: normalOfQuad().
void writeQuad(vec3 normal) {
  ivec2 local = ivec2(gl_LocalInvocationID.xy), quad = ownQuad();
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
  if (!insideLevel(levelRect(1u), quad)) return;
  if (isWholeQuad(material, depth)) {
    float area = areaOf(vec2(pixelOfQuad(quad)), normal);
    if (area == 0.0) area = areaOfQuad(quad, depth);
    writeLevel(1u, quad, wholeQuadTexel(material[0], depth, color, area));
    return;
  }
  vec4 area;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = withinRect(2 * quad + ivec2(i & 1, i >> 1));
    area[i] = areaOf(vec2(pixel), normalAt(pixel));
  }
  writeLevel(1u, quad, quadTexel(material, depth, color, area));
}

#endif
