// Words that say which cells of an image have material. Engines that know it write them in the place of the pass that looks
// (module/include/pellucid/pellucid_cells.h).
#ifndef PELLUCID_CELL_WORDS_GLSL
#define PELLUCID_CELL_WORDS_GLSL

#include "shared/pellucid_shared.h"

const int kBlockShift = 6, kCellShift = 3; // of PELLUCID_BLOCK and PELLUCID_CELL

// The texel that holds a word.
ivec2 tileWordPlace(uint word) {
  return ivec2(word & ((1u << PELLUCID_TILE_WORDS_SHIFT) - 1u), word >> PELLUCID_TILE_WORDS_SHIFT);
}

// The first of a block's PELLUCID_BLOCK_WORDS words; columns: of blocks.
uint firstWordOfBlock(uvec2 block, uint columns) { return uint(PELLUCID_BLOCK_WORDS) * (block.y * columns + block.x); }

// The block of a pixel, counted from the first pixel of block (0, 0).
ivec2 blockOfPixel(ivec2 pixel) { return pixel >> kBlockShift; }

// The cell of a pixel in its block, 0..7.
ivec2 cellOfPixel(ivec2 pixel) { return (pixel & (PELLUCID_BLOCK - 1)) >> kCellShift; }

// The bit of a cell, in the first of its block's words or the second: 0 or 1.
uint wordOfCell(ivec2 cell) { return uint(cell.y >> 2); }
uint bitOfCell(ivec2 cell) { return 1u << (8 * (cell.y & 3) + cell.x); }

// The third and the fourth word are floatBitsToUint() of the nearest and the farthest planar distance.

#endif
