// Makes levels 2 and 3 of the pyramid from level 1, in blocks. A group makes 8 x 4 texels of level 3 and, before them, the 18 x 10 of
// level 2 that they need.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#define GROUP_ROWS (PELLUCID_BLOCK_GROUP * 3 / 4)
#include "diffusion/texel.glsl"

const int kInvocations = GROUP_SIDE * GROUP_ROWS;
// A group's columns and rows of level 3, of the part of level 2 that it needs, and of the part of level 1 that this needs.
const ivec2 kThird = ivec2(PELLUCID_DOWNSAMPLE_COLUMNS, PELLUCID_DOWNSAMPLE_ROWS), kSecond = 2 * kThird + 2, kFirst = 2 * kSecond + 2;
// Level 1 and, once that has been used, level 2: the size limits how many groups run at a time.
#define HELD_TEXELS (kFirst.x * kFirst.y)
#include "diffusion/downsample.glsl"

// True where a texel and all around it are full and lie on one plane. `at`: the texel in colors[] and depths[] of `width`
// columns, not in the outermost rows and columns.
bool isFlatAround(uvec4 bits, ivec2 at, int width, uint level, vec2 ray) {
  float depth = uintBitsToFloat(bits.z), most = 0.0;
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  uint different = 0u;
  [[dont_unroll]] for (int y = -1; y <= 1; ++y)
    [[unroll]] for (int x = -1; x <= 1; ++x) { // the texel itself changes nothing
      int index = slot(at + ivec2(x, y), width);
      most = max(most, abs(depths[index] - depth - dot(slope, vec2(x, y) * size)));
      different |= colors[index].y ^ bits.y;
    }
  return isPlane(bits) && (different & kSamePlane) == 0u && most * most < kPlaneOffset / inverseSpread(slope, ray, size);
}

// Loads level 1's part, whose texel (0, 0) is `corner`.
void loadFirst(ivec2 corner, bool whole) {
  const int kRows = kInvocations / kFirst.x, kLoads = (kFirst.y + kRows - 1) / kRows;
  int column = int(gl_LocalInvocationIndex) % kFirst.x, row = int(gl_LocalInvocationIndex) / kFirst.x;
  int end = row < kRows ? kFirst.y : 0;
  // All loads come before the first use, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 at = ivec2(column, row + i * kRows);
    loaded[i] = at.y < end ? writtenQuad(corner + at, whole) : uvec4(0u);
  }
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 at = ivec2(column, row + i * kRows);
    if (at.y < end) keepLoaded(slot(at, kFirst.x), loaded[i]);
  }
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint word = listedBlock(nearList());
  ivec2 own = (firstPixel(blockOf(word)) >> 3) + ivec2(0, int(gl_WorkGroupID.y) * kThird.y);
  if (invocation == 0) anySurface = 0u;
  barrier();
  loadFirst(4 * own - 3, isWhole(word));
  barrier();
  [[dont_unroll]] for (int level = 2; level < 4; ++level) {
    // Level 2 begins with row 1 and ends with row 0, so that the last invocations make level 3 and write nothing of level 2.
    int place = level == 2 ? invocation + kSecond.x : invocation + kThird.x * kThird.y - kInvocations;
    ivec2 size = level == 2 ? kSecond : kThird, corner = level == 2 ? 2 * own - 1 : own;
    ivec2 at = level == 2 ? ivec2(place % kSecond.x, place / kSecond.x % kSecond.y) : ivec2(place % kThird.x, place / kThird.x);
    ivec2 texel = corner + at;
    int stride = 2 * size.x + 2;
    bool inside = level == 2 ? invocation < kSecond.x * kSecond.y : place >= 0, writes = inside && contains(levelRect(uint(level)), texel);
    bool makes = writes && anySurface != 0u; // texels of nothing are nothing
    uvec4 bits = makes ? downsampled(uint(level - 1), texel, 2 * at.y * stride + at.x, stride) : uvec4(0u);
    if (level == 2) {
      barrier();
      if (inside) keepTexel(slot(at, kSecond.x), bits);
      barrier();
      writes = writes && contains(ivec4(1, 1, kSecond - 1), at);
      if (writes && isFlatAround(bits, at, kSecond.x, 2u, facingRayAt(pixelOf(2u, texel)))) bits.x |= kFlat;
    }
    if (writes) writeLevel(uint(level), texel, bits);
  }
}
