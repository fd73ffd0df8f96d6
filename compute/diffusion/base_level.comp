// Makes level 1 of the pyramid from the pixels, a block of 64 x 64 a group: color, depth, slope and area of the surface of each quad
// of 2 x 2 pixels. Every pass takes surfaces from these texels. The pass lists where later ones have work: it finds which cells of the
// block hold material and how far away their surfaces are. It copies the pixels where the plan asks for it.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#include "diffusion/list_blocks.glsl"
#include "diffusion/texel.glsl"
#include "lib/surface.glsl"

layout(push_constant) uniform Pass { BaseLevelPass pass; };

const int kQuads = PELLUCID_BLOCK / 2 / GROUP_SIDE; // a side, of an invocation
const int kSide = PELLUCID_BLOCK / 2, kRow = kSide + 2; // quads of the block, and with those around it

shared uint cells[2];          // bits of rows 0 to 3 and 4 to 7
shared uint nearest, farthest; // bits of planar distances, which are above 0
// Surfaces of the block's quads and of those around it, as keepSurface has them. Before, colors[].x has the materials of a quad's pixels.
shared float depths[kRow * kRow];
shared uvec2 colors[kRow * kRow];

// The invocation's i-th quad of the block, so that neighbors do neighbors.
ivec2 quadInBlock(int i) { return ivec2(gl_LocalInvocationID.xy) + GROUP_SIDE * ivec2(i % kQuads, i / kQuads); }
ivec2 cellOfQuad(ivec2 quad) { return quad >> (kCellShift - 1); }
int placeOf(ivec2 quad) { return (quad.y + 1) * kRow + quad.x + 1; }

// The i-th quad around the block: the rows above and below, then the columns between them.
ivec2 quadAround(int i) {
  if (i < 2 * kRow) return ivec2(i % kRow - 1, i < kRow ? -1 : kSide);
  i -= 2 * kRow;
  return ivec2(i < kSide ? -1 : kSide, i % kSide);
}
const int kAround = 4 * kSide + 4;

// ---- The surface of a quad: the nearest of its pixels with material, and those of its material that a step of kSteepest reaches

const uint kAllPixels = 15u; // bits of a quad's pixels, rows first

struct QuadSurface {
  float depth;   // mean; -kNoDepth: there is none
  uint material; // index + 1; without a surface that of a pixel without depth, or 0
  uint pixels;
  bool ends; // a pixel has no material, or what it shows lies behind
};

// Largest slope of one surface, 83 degrees from facing the camera: a silhouette doubles it, which gives kMostArea.
const float kSteepest = 8.0;

// `materials`: of the quad's pixels, a byte each.
QuadSurface surfaceOf(float depth[4], uint materials) {
  QuadSurface s = QuadSurface(0.0, 0u, 0u, false);
  float front = kNoDepth, sum = 0.0;
  uint any = 0u;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    uint material = materials >> 8 * i & 255u;
    any = max(any, material);
    if (material == 0u || !(depth[i] > 0.0) || depth[i] >= front) continue;
    front = depth[i];
    s.material = material;
  }
  if (s.material == 0u) return QuadSurface(-kNoDepth, any, 0u, false);
  vec2 sides = squaredPixelSize(frame.camera, front);
  float reach = kSteepest * sqrt(min(sides.x, sides.y));
  [[unroll]] for (int i = 0; i < 4; ++i) {
    uint material = materials >> 8 * i & 255u;
    bool behind = material == 0u || !(depth[i] > 0.0) || depth[i] - front > reach;
    s.ends = s.ends || behind;
    if (behind || material != s.material) continue;
    sum += depth[i];
    s.pixels |= 1u << i;
  }
  s.depth = sum / float(bitCount(s.pixels)); // the nearest one counts
  return s;
}

const uint kEnds = 0x1000u;

// depths[]: the depth. colors[]: mean color of the pixels; in the upper half of y the material, from bit 8 on the pixels, and kEnds.
void keepSurface(ivec2 quad, QuadSurface s, vec3 color) {
  depths[placeOf(quad)] = s.depth;
  colors[placeOf(quad)] = packHalves(roundToHalf(color), s.material | s.pixels << 8 | (s.ends ? kEnds : 0u));
}
uint surfaceAt(int place) { return colors[place].y >> 16; }
uint materialOf(uint surface) { return surface & 255u; }
uint pixelsOf(uint surface) { return surface >> 8 & kAllPixels; }

// Mean place of a quad's pixels, texels from the quad's center.
vec2 centerOf(uint pixels) {
  if (pixels == kAllPixels) return vec2(0.0);
  float perPixel = 0.5 / float(max(bitCount(pixels), 1)); // finite where there is no surface, too
  return vec2(bitCount(pixels & 10u), bitCount(pixels & 12u)) * perPixel - 0.25;
}

// ---- Slope: the plane of least squares through a quad's depth, over the 3 x 3 quads around that lie on its surface

// Change of depth per texel along an axis to the neighbor of a quad on one side, 1 or -1; kFarthest: none of its material.
float stepTo(int place, int stride, int side, uint material, float own, float center) {
  int at = place + side * stride;
  uint bits = surfaceAt(at);
  vec2 other = centerOf(pixelsOf(bits));
  float change = (depths[at] - own) / (float(side) + (stride == 1 ? other.x : other.y) - center);
  return depths[at] > 0.0 && materialOf(bits) == material ? change : kFarthest;
}

float stepAlong(int place, int stride, uint material, float own, float center) {
  return nearerStep(stepTo(place, stride, 1, material, own, center), stepTo(place, stride, -1, material, own, center));
}

// Change of depth per texel. `center`: of the quad's pixels; `size`: of a texel at depth `own`.
vec2 slopeOfQuads(int place, uint material, float own, vec2 center, vec2 size, vec2 ray) {
  vec2 perTexel = vec2(stepAlong(place, 1, material, own, center.x), stepAlong(place, kRow, material, own, center.y));
  // A surface is another where it is a texel's side off along the ray.
  float perSquare = inverseSpread(perTexel / max(size, vec2(1.0e-30)), ray, size) * (1.0 + dot(ray, ray));
  vec2 tilt = vec2(0.0), spread = vec2(0.0);
  // Not unrolled, here and below: small frames wait for code.
  [[dont_unroll]] for (int i = 0; i < 9; ++i) { // the quad itself adds nothing
    ivec2 away = ivec2(i % 3, i / 3) - 1;
    int at = place + away.y * kRow + away.x;
    uint bits = surfaceAt(at);
    vec2 step = vec2(away) + centerOf(pixelsOf(bits)) - center;
    float off = depths[at] - own - dot(perTexel, step);
    float w = depths[at] > 0.0 && materialOf(bits) == material ? max(1.0 - off * off * perSquare, 0.0) : 0.0;
    tilt += w * off * step;
    spread += w * step * step;
  }
  return perTexel + tilt / max(spread, vec2(1.0e-3));
}

// Part of a texel's side that a plane's depths may be off: weights are then within 1 % of 1, less than areas are rounded by.
const float kNearPlane = 0.1;

// Factor of slopes at a silhouette, near which depth goes like the root of the distance to the silhouette. The last quad's center is half
// a quad away: its slope is 1.37 times the slope to the quad before, and the quad's mean slope, which the area takes, 1.41 times more.
const float kLimb = 1.41421356;

// kLimb where the surface ends in the quad or in the direction in which its depth grows, and no material lies nearer there.
float limbOf(int place, int stride, float own, float perTexel, float reach) {
  bool ends = (surfaceAt(place) & kEnds) != 0u || abs(depths[perTexel > 0.0 ? place + stride : place - stride]) - own > reach;
  return ends ? kLimb : 1.0;
}

// Change of depth per texel where all quads around are full and lie on one plane, whose weights are all 1: the means of both sides'
// differences. False where they do not.
bool slopeOfPlane(int place, float nearPlane, out vec2 perTexel) {
  uint own = surfaceAt(place), different = 0u;
  vec3 rows[3];
  [[unroll]] for (int y = 0; y < 3; ++y)
    [[unroll]] for (int x = 0; x < 3; ++x) {
      int at = place + (y - 1) * kRow + x - 1;
      rows[y][x] = depths[at];
      different |= surfaceAt(at) ^ own;
    }
  vec3 columns = rows[0] + rows[1] + rows[2], change = rows[2] - rows[0];
  perTexel = vec2(columns.z - columns.x, change.x + change.y + change.z) / 6.0;
  float most = 0.0;
  [[unroll]] for (int y = 0; y < 3; ++y) {
    vec3 off = abs(rows[y] - rows[1].y - float(y - 1) * perTexel.y - vec3(-perTexel.x, 0.0, perTexel.x));
    most = max(most, max(off.x, max(off.y, off.z)));
  }
  return different == 0u && own >> 8 == kAllPixels && most < nearPlane; // none ends
}

// The texel of a quad with a surface.
uvec4 texelOf(ivec2 first, ivec2 quad) {
  int place = placeOf(quad);
  float own = depths[place];
  uint material = materialOf(surfaceAt(place)), pixels = pixelsOf(surfaceAt(place));
  vec2 size = texelSize(own, 1u), ray = facingRayAt(pixelOf(1u, first + quad)), perSize = 1.0 / max(size, vec2(1.0e-30));
  vec2 perTexel, limb = vec2(1.0);
  if (!slopeOfPlane(place, kNearPlane * min(size.x, size.y), perTexel)) {
    perTexel = slopeOfQuads(place, material, own, centerOf(pixels), size, ray);
    float reach = 2.0 * kSteepest * min(size.x, size.y);
    limb = vec2(limbOf(place, 1, own, perTexel.x, reach), limbOf(place, kRow, own, perTexel.y, reach));
  }
  vec2 slope = limb * perTexel * perSize;
  float area = areaOf(1u, first + quad, limb * slope) * 0.25 * float(bitCount(pixels));
  return packTexel(Texel(unpackHalves(colors[place]), area, material, own, slope), pixels == kAllPixels ? kPlane : 0u);
}

// ---- Pixels

// Loads a quad of a cell with material, keeps its surface and copies its pixels.
void readQuad(ivec2 first, ivec2 quad, uint materials) {
  float depth[4];
  vec4 source[4];
  // All loads come before the first use, so that their latencies overlap.
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 at = inImage(withinRect(2 * (first + quad) + ivec2(i & 1, i >> 1)));
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  QuadSurface s = surfaceOf(depth, materials);
  float least = kNoDepth, most = 0.0;
  vec3 sum = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if ((materials >> 8 * i & 255u) == 0u) continue;
    vec3 color = sanitize(source[i].rgb);
    if (pass.copies != 0u) imageStore(destinationImage, inImage(2 * (first + quad) + ivec2(i & 1, i >> 1)), vec4(asStored(color, false), source[i].a));
    if ((s.pixels >> i & 1u) != 0u) sum += roundToHalf(color);
    if (!(depth[i] > 0.0)) continue;
    least = min(least, depth[i]);
    most = max(most, depth[i]);
  }
  keepSurface(quad, s, sum / float(max(bitCount(s.pixels), 1)));
  // Read first: most invocations have nothing to add. An old value costs an atomic more and changes nothing.
  if (!(most > 0.0)) return;
  if (floatBitsToUint(least) < nearest) atomicMin(nearest, floatBitsToUint(least));
  if (floatBitsToUint(most) > farthest) atomicMax(farthest, floatBitsToUint(most));
}

// Loads the surface of a quad around the block.
void readAround(ivec2 first, ivec2 quad, ivec4 rect) {
  float depth[4];
  uint materials = 0u;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 at = inImage(2 * (first + quad)) + ivec2(i & 1, i >> 1), within = clamp(at, rect.xy, rect.zw - 1);
    depth[i] = frontDistance(within);
    materials |= (at == within ? materialAt(within) : 0u) << 8 * i;
  }
  keepSurface(quad, surfaceOf(depth, materials), vec3(0.0));
}

bool cellHolds(ivec2 cell) { return (cells[cell.y >> 2] & cellBit(cell)) != 0u; }

void main() {
  uint block = gl_WorkGroupID.x;
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 first = firstPixel(block) / 2; // quad
  // The rect in pixels of the image takes 8 registers less than pixels of the lattice for each load.
  ivec4 rect = ivec4(inImage(ivec2(frame.rect.xy)), inImage(ivec2(frame.rect.zw)));
  if (invocation < 2) cells[invocation] = 0u;
  if (invocation == 0) {
    nearest = floatBitsToUint(kNoDepth);
    farthest = 0u;
  }
  barrier();
  [[dont_unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
    ivec2 quad = quadInBlock(i), cell = cellOfQuad(quad);
    uint materials = 0u;
    [[unroll]] for (int k = 0; k < 4; ++k) {
      ivec2 at = inImage(2 * first) + 2 * quad + ivec2(k & 1, k >> 1);
      materials |= (contains(rect, at) ? materialAt(at) : 0u) << 8 * k;
    }
    colors[placeOf(quad)].x = materials;
    if (materials != 0u && !cellHolds(cell)) atomicOr(cells[cell.y >> 2], cellBit(cell));
  }
  barrier();
  bool some = (cells[0] | cells[1]) != 0u;
  // Early, so that the pixels' loads hide the latency.
  if (goesByLists() && invocation < 9) countBlock(block, invocation, uvec2(cells[0], cells[1]));
  if (some) {
    if (invocation < kAround) readAround(first, quadAround(invocation), rect);
    [[dont_unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
      ivec2 quad = quadInBlock(i);
      if (cellHolds(cellOfQuad(quad)))
        readQuad(first, quad, colors[placeOf(quad)].x);
      else
        keepSurface(quad, QuadSurface(-kNoDepth, 0u, 0u, false), vec3(0.0));
    }
  }
  barrier();
  if (some) {
    [[dont_unroll]] for (int i = 0; i < kQuads * kQuads; ++i) {
      ivec2 quad = quadInBlock(i);
      if (!cellHolds(cellOfQuad(quad)) || !contains(levelRect(1u), first + quad)) continue;
      uint bits = surfaceAt(placeOf(quad));
      writeLevel(1u, first + quad, pixelsOf(bits) != 0u ? texelOf(first, quad) : uvec4(0u, materialOf(bits) << 24, 0u, 0u));
    }
  }
  if (invocation < 2) writeWord(blockWord(block, kCellWord + uint(invocation)), cells[invocation]);
  if (!goesByLists()) return;
  if (block == 0u && invocation < PELLUCID_LISTS) lists.commands[invocation].ran.x = 0u;
  if (farthest == 0u) return;
  for (uint i = uint(invocation); i < lists.maps.x * kEntryGroupRows; i += uint(GROUP_SIDE * GROUP_SIDE))
    listEntryGroups(i / kEntryGroupRows, block, int(i % kEntryGroupRows), uintBitsToFloat(nearest), uintBitsToFloat(farthest));
}
