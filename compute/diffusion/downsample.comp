// Makes levels 2 and 3 of the pyramid from level 1, in blocks. A group makes 8 x 4 texels of level 3 and, before them, the 18 x 10 of
// level 2 that they need.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#define GROUP_ROWS (PELLUCID_BLOCK_GROUP / 2)
#include "diffusion/texel.glsl"

const int kInvocations = GROUP_SIDE * GROUP_ROWS;
// Columns and rows of level 3's part, of the part of level 2 that it needs, and of the part of level 1 that this needs.
const int kThird = PELLUCID_DOWNSAMPLE_COLUMNS, kThirdRows = PELLUCID_DOWNSAMPLE_ROWS;
const int kSecond = 2 * kThird + 2, kSecondRows = 2 * kThirdRows + 2, kFirst = 2 * kSecond + 2, kFirstRows = 2 * kSecondRows + 2;
const int kLoads = (kFirst * kFirstRows + kInvocations - 1) / kInvocations;
const int kSeconds = (kSecond * kSecondRows + kInvocations - 1) / kInvocations;
// Level 1 and, once that has been used, level 2: the size limits how many groups run at a time.
const int kHeld = kFirst * kFirstRows;
#include "diffusion/downsample.glsl"

// True where a texel and all around it are full and lie on one plane. `at`: the texel in colors[] and depths[] of `width`
// columns, not in the outermost rows and columns.
bool isFlatAround(uvec4 bits, ivec2 at, int width, uint level, vec2 ray) {
  float depth = uintBitsToFloat(bits.z), most = 0.0;
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  uint different = 0u;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      int index = slot(at + ivec2(x, y), width);
      most = max(most, abs(depths[index] - depth - dot(slope, vec2(x, y) * size)));
      different |= colors[index].y ^ bits.y;
    }
  return isPlane(bits) && (different & kSamePlane) == 0u && most * most < kPlaneOffset / inverseSpread(slope, ray, size);
}

// The i-th place in the part of level 2: the inner ones first, row by row, which are what the group writes.
ivec2 placeInSecond(int i) {
  const int kInner = kSecond - 2, kInnerRows = kSecondRows - 2;
  if (i < kInner * kInnerRows) return ivec2(i % kInner, i / kInner) + 1;
  i -= kInner * kInnerRows; // the outermost rows, then the columns between them
  if (i < 2 * kSecond) return ivec2(i % kSecond, i < kSecond ? 0 : kSecondRows - 1);
  i -= 2 * kSecond;
  return ivec2(i < kInnerRows ? 0 : kSecond - 1, i % kInnerRows + 1);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint word = listedBlock(nearList());
  ivec2 own = (firstPixel(blockOf(word)) >> 3) + ivec2(0, int(gl_WorkGroupID.y) * kThirdRows);
  ivec2 start = 2 * own - 1, firstStart = 2 * start - 1;
  if (invocation == 0) anySurface = 0u;
  barrier();
  // All loads come before the first use, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    int at = invocation + i * kInvocations;
    loaded[i] = at < kFirst * kFirstRows ? writtenTexel(1u, firstStart + ivec2(at % kFirst, at / kFirst), isWhole(word)) : uvec4(0u);
  }
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    int at = invocation + i * kInvocations;
    if (at < kFirst * kFirstRows) keepLoaded(slot(ivec2(at % kFirst, at / kFirst), kFirst), loaded[i]);
  }
  barrier();
  bool some = anySurface != 0u; // texels of nothing are nothing
  uvec4 bits[kSeconds];
  [[unroll]] for (int i = 0; i < kSeconds; ++i) { // else bits[] would lie in memory
    int place = invocation + i * kInvocations;
    ivec2 at = placeInSecond(place);
    bool makes = some && place < kSecond * kSecondRows && contains(levelRect(2u), start + at);
    bits[i] = makes ? downsampled(1u, start + at, 2 * at.y * kFirst + at.x, kFirst) : uvec4(0u);
  }
  barrier();
  [[unroll]] for (int i = 0; i < kSeconds; ++i)
    if (invocation + i * kInvocations < kSecond * kSecondRows) keepTexel(slot(placeInSecond(invocation + i * kInvocations), kSecond), bits[i]);
  barrier();
  ivec2 at = placeInSecond(invocation); // one of the inner ones
  if (contains(levelRect(2u), start + at)) {
    if (isFlatAround(bits[0], at, kSecond, 2u, facingRayAt(pixelOf(2u, start + at)))) bits[0].x |= kFlat;
    writeLevel(2u, start + at, bits[0]);
  }
  at = ivec2(invocation % kThird, invocation / kThird);
  if (at.y < kThirdRows && contains(levelRect(3u), own + at))
    writeLevel(3u, own + at, some ? downsampled(2u, own + at, 2 * at.y * kSecond + at.x, kSecond) : uvec4(0u));
}
