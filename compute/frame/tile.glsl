// A group does a tile of pixels, an invocation two of them: one leaves too much to do for each pixel again, four hold so
// many registers that too few groups run at a time. A pass that does little may define FOUR_PIXELS.
#ifndef PELLUCID_TILE_GLSL
#define PELLUCID_TILE_GLSL

#ifndef TILE_SIDE
#define TILE_SIDE PELLUCID_TILE
#endif
#ifdef FOUR_PIXELS
#define GROUP_SIDE (TILE_SIDE / 2)
#else
#define GROUP_SIDE TILE_SIDE
#endif
#define GROUP_ROWS (TILE_SIDE / 2)
#include "frame/work_group.glsl"

const int kPixels = TILE_SIDE * TILE_SIDE / (GROUP_SIDE * GROUP_ROWS); // per invocation

// The invocation's i-th pixel. Its pixels are half a tile apart, so that neighbors load neighbors.
ivec2 pixelInTile(int i) {
#ifdef FOUR_PIXELS
  return ivec2(gl_LocalInvocationID.xy) + ivec2(GROUP_SIDE * (i & 1), GROUP_ROWS * (i >> 1));
#else
  return ivec2(gl_LocalInvocationID.xy) + ivec2(0, GROUP_ROWS * i);
#endif
}

// The first pixel of the group's tile. Tiles start at even pixels, so that quads of pixels are the image's.
ivec2 evenTile() { return firstBlockPixel() + ivec2(workGroup(PELLUCID_LIST_TILES)) * TILE_SIDE; }

#endif
