// The image of tile lists is an array of words: first those of the blocks, row by row, then a mark for each block that is near
// material, then the lists.
#ifndef PELLUCID_TILE_WORDS_GLSL
#define PELLUCID_TILE_WORDS_GLSL

#include "frame/bindings.glsl"
#include "lib/cell_words.glsl"

// The first of a block's words.
uint blockWord(uvec2 block) { return firstWordOfBlock(block, frame.blocks.x); }

// Blocks begin where tiles do: at an even pixel.
ivec2 firstBlockPixel() { return ivec2(frame.rect.xy) & ~1; }

// `whole`: all that the group reads of the pass before has been written.
uint packGroup(uvec2 group, bool whole) {
  return group.x | (whole ? PELLUCID_GROUP_WHOLE : 0u) | group.y << PELLUCID_GROUP_ROW_SHIFT;
}
uvec2 unpackGroup(uint word) { return uvec2(word & PELLUCID_GROUP_COLUMN, word >> PELLUCID_GROUP_ROW_SHIFT); }
bool isWhole(uint word) { return (word & PELLUCID_GROUP_WHOLE) != 0u; }

// Words are read as far as the list's command counts them, so that they hold what list_groups.comp wrote.
// Groups of entry points have a map, too, which has at most 64 x 64 of them.
uint packEntryGroup(uvec3 group) { return group.x | group.y << 8 | group.z << PELLUCID_GROUP_MAP_SHIFT; }
uvec3 unpackEntryGroup(uint word) { return uvec3(word & 0xFFu, word >> 8 & 0xFFu, word >> PELLUCID_GROUP_MAP_SHIFT); }

#endif
