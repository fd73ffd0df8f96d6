// The base level of the diffusion pyramid, level 1, from the pixels, which are copied where the plan asks for it.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define FOUR_PIXELS
#include "frame/tile.glsl"
#include "frame/normal_image.glsl"
#include "diffusion/pyramid.glsl"

const int kTile = TILE_SIDE, kQuads = kTile / 2; // of a row
shared uvec2 tileColors[kTile * TILE_SIDE]; // and material
shared float tileDepths[kTile * TILE_SIDE];

// `color`: of halves.
void keepPixel(ivec2 inTile, vec3 color, float depth, uint material) {
  tileColors[inTile.y * kTile + inTile.x] = packHalves(color, material);
  tileDepths[inTile.y * kTile + inTile.x] = depth;
}

// The first invocations do a quad each.
bool hasQuad() { return gl_LocalInvocationIndex < uint(kQuads * TILE_SIDE / 2); }
ivec2 quadInTile() { return ivec2(gl_LocalInvocationIndex % uint(kQuads), gl_LocalInvocationIndex / uint(kQuads)); }

// The pixel whose normal stands for a quad that is one surface: any of the four, by turns.
ivec2 pixelOfQuad(ivec2 quad) { return 2 * quad + (quad.yx & 1); }

// The normal of the invocation's quad, to be loaded with all the rest.
vec3 normalOfQuad(ivec2 tile) {
  return hasQuad() ? normalAt(withinRect(pixelOfQuad((tile >> 1) + quadInTile()))) : vec3(0.0);
}

// After a barrier. `normal`: normalOfQuad().
void writeQuad(ivec2 tile, vec3 normal) {
  ivec2 local = quadInTile(), quad = (tile >> 1) + local;
  if (!hasQuad()) return;
  bool inside = contains(levelRect(1u), quad);
  float depth[4];
  uvec2 packed[4];
  for (int i = 0; i < 4; ++i) {
    int at = (2 * local.y + (i >> 1)) * kTile + 2 * local.x + (i & 1);
    packed[i] = tileColors[at];
    depth[i] = tileDepths[at];
  }
  // An empty quad looks nothing up.
  if ((packed[0].y | packed[1].y | packed[2].y | packed[3].y) >> 16 == 0u) {
    if (inside) writeLevel(1u, quad, uvec4(0u));
    return;
  }
  if (isWholeQuad(packed, depth)) {
    float area = areaOf(vec2(pixelOfQuad(quad)), normal);
    if (area == 0.0) area = areaOfQuad(quad, depth);
    if (inside) writeLevel(1u, quad, wholeQuadTexel(packed, depth, area));
    return;
  }
  uint material[4];
  vec3 color[4];
  vec4 area;
  for (int i = 0; i < 4; ++i) {
    material[i] = packed[i].y >> 16;
    color[i] = unpackColor(packed[i]);
    ivec2 pixel = withinRect(2 * quad + ivec2(i & 1, i >> 1));
    area[i] = areaOf(vec2(pixel), normalAt(pixel));
  }
  if (inside) writeLevel(1u, quad, quadTexel(material, depth, color, area));
}

void main() {
  ivec2 tile = evenTile();
  uint material[kPixels];
  float depth[kPixels];
  vec4 source[kPixels];
  vec3 normal = normalOfQuad(tile);
  // All at once, so that the latencies overlap.
  for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = tile + pixelInTile(i);
    ivec2 at = withinRect(pixel);
    material[i] = at == pixel ? materialAt(at) : 0u;
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  for (int i = 0; i < kPixels; ++i) {
    vec3 color = sanitize(source[i].rgb);
    if (pass.value.x != 0u && material[i] != 0u)
      imageStore(destinationImage, tile + pixelInTile(i), vec4(asStored(color), source[i].a));
    keepPixel(pixelInTile(i), roundToHalf(color), depth[i], material[i]);
  }
  barrier();
  writeQuad(tile, normal);
}
