// Levels of entry points. One of level l is the entry point of the texel in the middle of 2^l x 2^l entry points of level 0. A probe
// reads one level of a map, and list_blocks.glsl lists groups of the levels that probes of a block may read.
#ifndef PELLUCID_ENTRY_LEVEL_GLSL
#define PELLUCID_ENTRY_LEVEL_GLSL

#include "frame/frame.glsl"

// Largest side of an entry point, per side of the cell that reads it: a pixel of the largest cells, which have 4 x 4.
const float kMostOfCell = 0.25;

// Shorter side of a cell of `pixels` a side at a planar distance, scene units. It is monotonic in the distance.
float cellSide(float planar, uint pixels) {
  vec2 squared = squaredPixelSize(frame.camera, planar);
  return float(pixels) * sqrt(min(squared.x, squared.y));
}

// The coarsest level whose entry points are narrow enough for a cell. `side`: of an entry point of level 0 at the probe, scene units.
int entryLevel(float side, float cell) {
  int level = 0;
  for (int i = 1; i < PELLUCID_ENTRY_LEVELS; ++i) level += float(1 << i) * side <= kMostOfCell * cell ? 1 : 0;
  return level;
}

// Place of a level's first entry point of a map in the image. Level 1 is beside level 0, each coarser one below the level before.
// `first`: of level 0; `size`: of the image's part with level 0. Both are of whole groups.
ivec2 entryPlace(ivec2 first, int level, ivec2 size) {
  ivec2 corner = level == 0 ? ivec2(0) : ivec2(size.x, size.y - (size.y >> (level - 1)));
  return corner + (first >> level);
}

#endif
