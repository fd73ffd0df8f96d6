// Makes levels 4 to 7 of the pyramid from level 3, as far as level pass.coarsest. A group makes 2 x 1 texels of level 7 and all texels
// of levels 4 to 6 under them. It makes anew what its texels need of other groups' parts, so that one dispatch makes all levels.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#include "diffusion/texel.glsl"

layout(push_constant) uniform Pass { CoarseLevelsPass pass; };

const int kInvocations = GROUP_SIDE * GROUP_SIDE;
// Columns and rows of level 7 that a group makes. The group needs ((kOwn + 2) << i) - 2 texels of level 7 - i: twice as many as of the
// coarser level, and one more on each side.
const ivec2 kOwn = ivec2(PELLUCID_COARSE_COLUMNS, PELLUCID_COARSE_ROWS);
const ivec2 kThird = ((kOwn + 2) << 4) - 2, kFourth = ((kOwn + 2) << 3) - 2;
// Level 4 is made in parts of so many rows, since level 3's window does not fit. A part's input lies behind the parts before it.
const int kPartRows = kInvocations / (kFourth.x + 2), kParts = (kFourth.y + kPartRows - 1) / kPartRows;
const int kPartTexels = kPartRows * kFourth.x, kInputRows = 2 * kPartRows + 2;
#define HELD_TEXELS ((kParts - 2) * kPartTexels + kInputRows * kThird.x) // the last part has fewer rows
#include "diffusion/downsample.glsl"

// Loads rows [first, first + kInputRows) of level 3's window, whose texel (0, 0) is `corner`, into slots that are row by row from
// `origin` on.
void loadRows(ivec2 corner, int first, int origin) {
  const int kColumns = kThird.x + 2, kLoads = (kInputRows * kColumns + kInvocations - 1) / kInvocations;
  int column = int(gl_LocalInvocationIndex) % kColumns, row = first + int(gl_LocalInvocationIndex) / kColumns;
  int end = column < kThird.x ? min(first + kInputRows, kThird.y) : 0;
  // All loads come before the first use, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 at = ivec2(column, row + i * (kInvocations / kColumns));
    loaded[i] = at.y < end ? writtenTexel(3u, corner + at) : uvec4(0u);
  }
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 at = ivec2(column, row + i * (kInvocations / kColumns));
    if (at.y < end) keepLoaded(origin + slot(at, kThird.x), loaded[i]);
  }
}

void main() {
  int invocation = int(gl_LocalInvocationIndex), group = int(gl_WorkGroupID.x), columns = int(pass.columns);
  const ivec2 kOwnShift = ivec2(findMSB(kOwn.x), findMSB(kOwn.y));
  ivec2 own = ((levelRect(7u).xy >> kOwnShift) + ivec2(group % columns, group / columns)) * kOwn;
  if (invocation == 0) anySurface = 0u;
  barrier();
  int from = 0, to = 0; // slots of texel (0, 0) of the finer level's window and of the level's
  [[dont_unroll]] for (int i = 0; i < kParts + int(pass.coarsest) - 4; ++i) {
    int part = min(i, kParts - 1), level = 4 + i - part, shift = 7 - level, firstRow = 0;
    ivec2 size = ((kOwn + 2) << shift) - 2, corner = ((own - 1) << shift) + 1; // of the level's window
    int stride = 2 * size.x + 2;
    if (level == 4) {
      firstRow = part * kPartRows;
      from = part * kPartTexels - 2 * firstRow * stride;
      loadRows(2 * corner - 1, 2 * firstRow, from);
      barrier();
    }
    ivec2 at = ivec2(invocation & (size.x + 1), firstRow + (invocation >> findMSB(size.x + 2))), texel = corner + at;
    bool inside = all(lessThan(at, size)), exists = contains(levelRect(uint(level)), texel);
    bool makes = inside && exists && anySurface != 0u; // texels of nothing are nothing
    uvec4 bits = makes ? downsampled(uint(level - 1), texel, from + 2 * at.y * stride + at.x, stride) : uvec4(0u);
    barrier(); // parts of level 4 lie where their input was
    if (inside) keepTexel(to + slot(at, size.x), bits);
    if (exists && contains(ivec4(own, own + kOwn), texel >> shift)) writeLevel(uint(level), texel, bits);
    barrier();
    if (part < kParts - 1) continue;
    from = to;
    to += size.x * size.y;
  }
}
