// What a group does of all tiles. Of the including pass: sums(), whether pixels of a texel of level 2 are summed.
#ifndef PELLUCID_FAST_EDGES_TILES_GLSL
#define PELLUCID_FAST_EDGES_TILES_GLSL

// Tiles of a group lie far from each other, so that all groups have as much to do: `index` of `groups`.
ivec2 tileOf(uint i, uint index, uint groups) {
  ivec2 first = ivec2(frame.rect.xy) / kTile, size = (ivec2(frame.rect.zw) - 1) / kTile - first + 1;
  int tile = int(index + i * groups);
  return kTile * (first + ivec2(tile % size.x, tile / size.x));
}

void sumTiles(uint index, uint groups, uint made, bool isLast) {
  uint invocation = gl_LocalInvocationIndex;
  if (invocation < uint(PELLUCID_FAST_EDGES_TILES)) edges[invocation] = 0u;
  barrier();
  uint tile = invocation / uint(kTexels * kTexels), inTile = invocation % uint(kTexels * kTexels);
  if (tile < uint(PELLUCID_FAST_EDGES_TILES)) {
    ivec2 texel = (tileOf(tile, index, groups) >> 2) + ivec2(inTile % uint(kTexels), inTile / uint(kTexels));
    // Those of the border have no pixels.
    if (contains(inset(levelRect(2u), 1), texel) && sums(texel)) atomicOr(edges[tile], 1u << inTile);
  }
  barrier();
  for (uint i = 0u; i < uint(PELLUCID_FAST_EDGES_TILES); ++i)
    if (edges[i] != 0u) diffuseTile(tileOf(i, index, groups), edges[i], made, isLast);
}

#endif
