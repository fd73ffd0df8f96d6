// The image of tile lists is an array of words: first those of the blocks, row by row, then a mark for each block that is near
// material, then the lists.
#ifndef PELLUCID_TILE_WORDS_GLSL
#define PELLUCID_TILE_WORDS_GLSL

#include "frame/bindings.glsl"

const int kBlockShift = 6, kCellShift = 3; // of PELLUCID_BLOCK and PELLUCID_CELL

ivec2 tileWordPlace(uint word) {
  return ivec2(word & ((1u << PELLUCID_TILE_WORDS_SHIFT) - 1u), word >> PELLUCID_TILE_WORDS_SHIFT);
}

// The first of a block's words.
uint blockWord(uvec2 block) { return uint(PELLUCID_BLOCK_WORDS) * (block.y * frame.blocks.x + block.x); }

// Blocks begin where tiles do: at an even pixel.
ivec2 firstBlockPixel() { return ivec2(frame.rect.xy) & ~1; }

// `whole`: all that the group reads of the pass before has been written.
uint packGroup(uvec2 group, bool whole) { return group.x | (whole ? 0x8000u : 0u) | group.y << 16; }
uvec2 unpackGroup(uint word) { return uvec2(word & 0x7FFFu, word >> 16); }
bool isWhole(uint word) { return (word & 0x8000u) != 0u; }

// Groups of entry points have a map, too, which has at most 64 x 64 of them.
uint packEntryGroup(uvec3 group) { return group.x | group.y << 8 | group.z << 16; }
uvec3 unpackEntryGroup(uint word) { return uvec3(word & 0xFFu, word >> 8 & 0xFFu, word >> 16); }

#endif
