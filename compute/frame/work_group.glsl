// A group's place in the grid of its pass. Passes run over lists of the groups that have work; see compute/tiles/.
#ifndef PELLUCID_WORK_GROUP_GLSL
#define PELLUCID_WORK_GROUP_GLSL

#include "frame/tile_words.glsl"

layout(set = 0, binding = PELLUCID_BINDING_TILES) uniform utexture2D tilesImage;

uint tileWord(uint word) { return texelFetch(tilesImage, tileWordPlace(word), 0).x; }

// Without lists all groups run.
bool goesByLists() { return frame.blocks.w != 0u; }

uint listedWord(uint list) { return tileWord(frame.lists[list >> 2][list & 3u] + gl_WorkGroupID.x); }

// True unless the group's list says that all it reads has been written.
bool readsUnwritten(uint list) { return goesByLists() && !isWhole(listedWord(list)); }

uvec2 workGroup(uint list) {
  if (!goesByLists()) return gl_WorkGroupID.xy;
  uvec2 listed = unpackGroup(listedWord(list));
  return uvec2(listed.x, listed.y * frame.listRows[list >> 2][list & 3u] + gl_WorkGroupID.y);
}

// True where the pass before wrote a texel: in a block with material or beside one. All else is nothing. `pixel`: the texel's
// first one.
bool isNearMaterial(ivec2 pixel) {
  // Levels have a border beyond the image, which counts with the nearest block.
  ivec2 block = clamp(blockOfPixel(pixel - firstBlockPixel()), ivec2(0), ivec2(frame.blocks.xy) - 1);
  return tileWord(frame.blocks.z + uint(block.y) * frame.blocks.x + uint(block.x)) != 0u;
}

// True where a pixel's cell of 8 x 8 has material.
bool isInCell(ivec2 pixel) {
  ivec2 at = pixel - firstBlockPixel(), block = blockOfPixel(at);
  if (!contains(ivec4(0, 0, frame.blocks.xy), block)) return false;
  ivec2 cell = cellOfPixel(at);
  return (tileWord(blockWord(uvec2(block)) + wordOfCell(cell)) & bitOfCell(cell)) != 0u;
}

#endif
