#ifndef PELLUCID_GROUP_ORDER_GLSL
#define PELLUCID_GROUP_ORDER_GLSL

// Groups start in the order of their indices, so what takes longest comes first and ends while others still run: the
// rect's borders, which are edges. Left and right columns, then the last row and the first.
uvec2 bordersFirst() {
  uvec2 count = gl_NumWorkGroups.xy;
  uint inner = count.x - 2u, index = gl_WorkGroupID.y * count.x + gl_WorkGroupID.x, columns = 2u * count.y;
  if (count.x < 3u) return gl_WorkGroupID.xy;
  if (index < columns) return uvec2((index & 1u) * (count.x - 1u), index >> 1);
  index -= columns;
  uint row = index / inner;
  return uvec2(1u + index - row * inner, (row + count.y - 1u) % count.y);
}

#endif
