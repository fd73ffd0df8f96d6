#ifndef PELLUCID_GROUP_ORDER_GLSL
#define PELLUCID_GROUP_ORDER_GLSL

#include "frame/work_group.glsl"

// The place of the group. Groups start in the order of their indices; the rect's borders, which are edges, take longest
// and come first, so that they end while others still run: left and right columns, then the last row and the first.
uvec2 bordersFirst() {
  uvec2 count = gl_NumWorkGroups.xy;
  uint index = gl_WorkGroupID.y * count.x + gl_WorkGroupID.x;
  uint inner = max(count.x, 3u) - 2u, columns = 2u * count.y;
  uint rest = max(index, columns) - columns;
  // All loads wait for this division, and integers take several times as long as floats. The result is exact: the quotient
  // errs by less than 1e-6 of some thousand rows, and the half keeps it 1 / (2 inner) away from the next row.
  uint row = uint((float(rest) + 0.5) / float(inner));
  uvec2 inRow = uvec2(1u + rest - row * inner, row == 0u ? count.y - 1u : row - uint(row < count.y));
  uvec2 inColumn = uvec2((index & 1u) * (count.x - 1u), index >> 1);
  // Groups of one or two columns keep their order.
  return count.x < 3u ? uvec2(index & (count.x - 1u), index >> (count.x - 1u)) : index < columns ? inColumn : inRow;
}

// As workGroup, and borders first where all groups run.
uvec2 workGroupBordersFirst(uint list) { return goesByLists() ? workGroup(list) : bordersFirst(); }

#endif
