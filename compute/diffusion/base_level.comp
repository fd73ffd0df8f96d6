// Makes level 1 of the pyramid from the pixels, a block of 64 x 64 a group, and finds which cells of the block hold material and
// how far away their surfaces are. It copies the pixels where the plan asks for it.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#include "diffusion/texel.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LISTS) buffer Lists {
  BlockLists lists;
  uint entryGroups[];
};

const int kQuads = PELLUCID_BLOCK / 2 / GROUP_SIDE; // a side, of an invocation

shared uint cells[2];          // bits of rows 0 to 3 and 4 to 7
shared uint nearest, farthest; // bits of planar distances, which are above 0

// The invocation's i-th quad of the block, so that neighbors do neighbors.
ivec2 quadInBlock(int i) { return ivec2(gl_LocalInvocationID.xy) + GROUP_SIDE * ivec2(i % kQuads, i / kQuads); }
ivec2 cellOfQuad(ivec2 quad) { return quad >> (kCellShift - 1); }

// ---- A texel from its quad: four pixels, rows first, packed by packHalves(color, material); depth <= 0: none

// Projected-area weight of a quad that is one surface, as its depths say.
float areaOfQuad(ivec2 quad, float depth[4]) {
  vec2 rise = 0.5 * vec2(depth[1] - depth[0] + depth[3] - depth[2], depth[2] - depth[0] + depth[3] - depth[1]);
  return areaOf(1u, quad, rise * inversesqrt(max(squaredPixelSize(frame.camera, depth[0]), vec2(1.0e-30))));
}

// True where the four pixels are one surface.
bool isWholeQuad(uvec2 packed[4], float depth[4]) {
  uint first = packed[0].y, different = (first ^ packed[1].y) | (first ^ packed[2].y) | (first ^ packed[3].y);
  float nearest = min(min(depth[0], depth[1]), min(depth[2], depth[3]));
  float farthest = max(max(depth[0], depth[1]), max(depth[2], depth[3]));
  bool one = nearest > 0.0 && first >> 16 != 0u && different >> 16 == 0u;
  vec2 sides = squaredPixelSize(frame.camera, nearest);
  float span = farthest - nearest;
  return one && span * span < 64.0 * min(sides.x, sides.y);
}

uvec4 wholeQuadTexel(uvec2 packed[4], float depth[4], float area) {
  vec3 color = unpackHalves(packed[0]) + unpackHalves(packed[1]) + unpackHalves(packed[2]) + unpackHalves(packed[3]);
  float sum = depth[0] + depth[1] + depth[2] + depth[3];
  return packTexel(Texel(0.25 * color, area, packed[0].y >> 16, 0.25 * sum, vec2(0.0)), kPlane);
}

// The texel takes the nearest pixel's surface. A pixel behind it counts if its depth is within a pixel's step of a surface as steep
// as its own, or as one 83 degrees from facing the camera.
uvec4 edgeQuadTexel(ivec2 quad, uvec2 packed[4], float depth[4]) {
  uint nearestMaterial = 0u, any = 0u;
  float nearest = kNoDepth;
  for (int i = 0; i < 4; ++i) {
    uint material = packed[i].y >> 16;
    any = max(any, material);
    if (material == 0u || !(depth[i] > 0.0) || depth[i] >= nearest) continue;
    nearest = depth[i];
    nearestMaterial = material;
  }
  if (nearestMaterial == 0u) return uvec4(0u, any << 24, 0u, 0u);
  vec2 sides = squaredPixelSize(frame.camera, nearest);
  float side = sqrt(min(sides.x, sides.y));
  vec3 mean = vec3(0.0);
  float sum = 0.0, weights = 0.0, areas = 0.0;
  for (int i = 0; i < 4; ++i) {
    bool counts = depth[i] > 0.0 && packed[i].y >> 16 == nearestMaterial &&
                  depth[i] - nearest <= 8.0 * side;
    // Across an edge depths say nothing of slopes.
    float w = counts ? 1.0 : 0.0, a = w;
    mean += a * unpackHalves(packed[i]);
    sum += counts ? depth[i] : 0.0;
    weights += w;
    areas += a;
  }
  // The nearest counts, so weights >= 1; areas are positive.
  return packTexel(Texel(mean / areas, 0.25 * areas, nearestMaterial, sum / weights, vec2(0.0)), 0u);
}

uvec4 texelOfQuad(ivec2 quad, uvec2 packed[4], float depth[4]) {
  // An empty quad looks nothing up.
  if ((packed[0].y | packed[1].y | packed[2].y | packed[3].y) >> 16 == 0u) return uvec4(0u);
  if (!isWholeQuad(packed, depth)) return edgeQuadTexel(quad, packed, depth);
  return wholeQuadTexel(packed, depth, areaOfQuad(quad, depth));
}

// Makes a quad's texel of level 1. `materials`: of its pixels, a byte each.
void writeQuad(ivec2 quad, uint materials) {
  uvec2 packed[4];
  float depth[4];
  vec4 source[4];
  // All loads come before the first use, so that their latencies overlap.
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 at = inImage(withinRect(2 * quad + ivec2(i & 1, i >> 1)));
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  float least = kNoDepth, most = 0.0;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    uint material = materials >> 8 * i & 255u;
    vec3 color = sanitize(source[i].rgb);
    packed[i] = packHalves(roundToHalf(color), material);
    if (material == 0u) continue;
    if (pass.value.x != 0u) imageStore(destinationImage, inImage(2 * quad + ivec2(i & 1, i >> 1)), vec4(asStored(color), source[i].a));
    if (!(depth[i] > 0.0)) continue;
    least = min(least, depth[i]);
    most = max(most, depth[i]);
  }
  writeLevel(1u, quad, texelOfQuad(quad, packed, depth));
  // Read first: most invocations have nothing to add. An old value costs an atomic more and changes nothing.
  if (!(most > 0.0)) return;
  if (floatBitsToUint(least) < nearest) atomicMin(nearest, floatBitsToUint(least));
  if (floatBitsToUint(most) > farthest) atomicMax(farthest, floatBitsToUint(most));
}

void main() {
  uint block = gl_WorkGroupID.x, invocation = gl_LocalInvocationIndex;
  ivec2 first = firstPixel(block) / 2; // quad
  // The rect in pixels of the image takes 8 registers less than pixels of the lattice for each load.
  ivec4 rect = ivec4(inImage(ivec2(frame.rect.xy)), inImage(ivec2(frame.rect.zw)));
  uint materials[kQuads * kQuads];
  [[unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
    materials[i] = 0u;
    [[unroll]] for (int k = 0; k < 4; ++k) {
      ivec2 at = inImage(2 * first) + 2 * quadInBlock(i) + ivec2(k & 1, k >> 1);
      materials[i] |= (contains(rect, at) ? materialAt(at) : 0u) << 8 * k;
    }
  }
  if (invocation < 2u) cells[invocation] = 0u;
  if (invocation == 0u) {
    nearest = floatBitsToUint(kNoDepth);
    farthest = 0u;
  }
  barrier();
  [[unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
    ivec2 cell = cellOfQuad(quadInBlock(i));
    if (materials[i] != 0u && (cells[cell.y >> 2] & cellBit(cell)) == 0u) atomicOr(cells[cell.y >> 2], cellBit(cell));
  }
  barrier();
  [[unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
    ivec2 cell = cellOfQuad(quadInBlock(i)), quad = first + quadInBlock(i);
    if ((cells[cell.y >> 2] & cellBit(cell)) != 0u && contains(levelRect(1u), quad)) writeQuad(quad, materials[i]);
  }
  barrier();
  if (invocation < 2u) writeWord(blockWord(block, kCellWord + invocation), cells[invocation]);
  if (invocation == 2u) writeWord(blockWord(block, kNearestWord), nearest);
  if (invocation == 3u) writeWord(blockWord(block, kFarthestWord), farthest);
  // All lists become empty: a recording may run more than once.
  if (block == 0u) {
    if (invocation < uint(PELLUCID_LISTS)) lists.commands[invocation].x = 0u;
    for (uint i = invocation; i < lists.maps.x * uint(PELLUCID_ENTRY_GROUP_WORDS); i += uint(GROUP_SIDE * GROUP_SIDE)) entryGroups[i] = 0u;
  }
}
