// Makes the two levels of the diffusion pyramid after level pass.value.x. A group makes 7 x 7 texels of the second level
// and, before them, the 16 x 16 of the first that they need: one an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DOWNSAMPLE_GROUP
#include "diffusion/pyramid.glsl"
#include "diffusion/written.glsl"
#include "frame/group_order.glsl"

// Sides of the first level's part and of the input; rows of the input that the invocations load at a time, and how often.
const int kFirst = PELLUCID_DOWNSAMPLE_GROUP, kInput = 2 * kFirst + 2;
const int kLoadRows = kFirst * kFirst / kInput, kLoads = (kInput + kLoadRows - 1) / kLoadRows;
// The arrays hold the input and, once that has been used, the first level: their size limits how many groups run at a time.
shared uvec2 colors[kInput * kInput]; // and area, material and plane, as packed
shared float depths[kInput * kInput];
shared uint anySurface; // in the input

#include "diffusion/downsampled.glsl"
#include "diffusion/flat.glsl"

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  if (invocation == 0) anySurface = 0u;
  barrier();
  uint finer = pass.value.x;
  ivec4 finerRect = levelRect(finer), rect = levelRect(finer + 1u), lastRect = levelRect(finer + 2u);
  uint list = finer == 1u ? PELLUCID_LIST_DOWNSAMPLE : PELLUCID_LIST_DOWNSAMPLE_COARSE;
  ivec2 own = lastRect.xy + PELLUCID_DOWNSAMPLE_TILE * ivec2(workGroupBordersFirst(list)), start = 2 * own - 1;
  ivec2 mine = ivec2(invocation % kInput, invocation / kInput), firstLoad = 2 * start - 1 + mine;
  // The level has so many rows from its first one on, in this column and where the invocation has a row.
  bool loads = mine.y < kLoadRows && firstLoad.x >= finerRect.x && firstLoad.x < finerRect.z;
  uint rows = loads ? uint(finerRect.w - finerRect.y) : 0u, row = uint(firstLoad.y - finerRect.y);
  // All loads come before the first use, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    ivec2 from = firstLoad + ivec2(0, j * kLoadRows);
    loaded[j] = row + uint(j * kLoadRows) < rows ? finerTexel(list, finer, from) : uvec4(0u);
  }
  [[unroll]] for (int j = 0; j < kLoads; ++j)
    if (mine.y < kLoadRows && mine.y + j * kLoadRows < kInput) {
      if (loaded[j].y >> 16 != 0u) anySurface = 1u;
      keepTexel(slot(mine, kInput) + j * kLoadRows * kInput, loaded[j]);
    }
  barrier();
  ivec2 at = ivec2(gl_LocalInvocationID.xy), texel = start + at;
  bool inside = contains(rect, texel), some = anySurface != 0u; // texels of nothing are nothing
  uvec4 bits = some && inside ? downsampled(finer, texel, 2 * at.y * kInput + at.x, kInput, 16) : uvec4(0u);
  barrier();
  keepTexel(slot(at, kFirst), bits);
  barrier();
  if (inside && contains(ivec4(1, 1, ivec2(kFirst - 1)), at)) { // the outer ones are the groups' beside
    if (finer == 1u && isFlatAround(bits, at, kFirst, 2u)) bits.x |= kFlat;
    writeLevel(finer + 1u, texel, bits);
  }
  at = ivec2(invocation % PELLUCID_DOWNSAMPLE_TILE, invocation / PELLUCID_DOWNSAMPLE_TILE);
  texel = own + at;
  if (at.y < PELLUCID_DOWNSAMPLE_TILE && contains(lastRect, texel))
    writeLevel(finer + 2u, texel, some ? downsampled(finer + 1u, texel, 2 * at.y * kFirst + at.x, kFirst, 16) : uvec4(0u));
}
