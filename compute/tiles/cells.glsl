// Questions about the cells with material.
#ifndef PELLUCID_CELLS_GLSL
#define PELLUCID_CELLS_GLSL

uint readTileWord(uint word) { return imageLoad(tilesDestination, tileWordPlace(word)).x; }

// Not 0 where the block of these words has material.
uint bitsOfBlock(uint word) { return readTileWord(word) | readTileWord(word + 1u); }

// Blocks [xy, zw) that the pixels [xy, zw) from the first block on lie in. All of them beyond the image: the nearest.
ivec4 blocksOf(ivec4 part) {
  ivec4 blocks = ivec4(part.xy >> kBlockShift, ((part.zw - 1) >> kBlockShift) + 1);
  return clamp(blocks, ivec4(0, 0, 1, 1), ivec4(ivec2(frame.blocks.xy) - 1, ivec2(frame.blocks.xy)));
}

// Bits of the cells [first, end) along an axis of a block, of 0 to 7.
uint cellBits(int first, int end) {
  uint from = uint(clamp(first, 0, 8)), to = uint(clamp(end, 0, 8));
  return to > from ? (1u << to) - (1u << from) : 0u;
}

struct Material {
  bool some, all; // somewhere, everywhere
};

// Material of the cells that a part of the image touches.
Material materialOfCells(ivec4 part) {
  const int kShift = kBlockShift - kCellShift;
  ivec4 cells = ivec4(part.xy >> kCellShift, ((part.zw - 1) >> kCellShift) + 1), blocks = blocksOf(part);
  uint some = 0u, lacks = 0u;
  // No early exit: it would wait for each word.
  for (int y = blocks.y; y < blocks.w; ++y)
    for (int x = blocks.x; x < blocks.z; ++x) {
      uint columns = cellBits(cells.x - (x << kShift), cells.z - (x << kShift)) * 0x01010101u;
      uint rows = cellBits(cells.y - (y << kShift), cells.w - (y << kShift)), word = blockWord(uvec2(x, y));
      [[unroll]] for (uint i = 0u; i < 2u; ++i) {
        uint four = rows >> (4u * i) & 15u; // a bit a row becomes a byte of ones
        uint mask = columns & (((four & 1u) | (four & 2u) << 7 | (four & 4u) << 14 | (four & 8u) << 21) * 255u);
        uint bits = readTileWord(word + i);
        some |= bits & mask;
        lacks |= ~bits & mask;
      }
    }
  return Material(some != 0u, lacks == 0u);
}

// Material of blocks, at most 6 in a row.
Material materialOfBlocks(ivec4 blocks) {
  uint some = 0u;
  bool all = true;
  for (int y = blocks.y; y < blocks.w; ++y)
    [[unroll]] for (int i = 0; i < 6; ++i) {
      int x = blocks.x + i;
      if (x >= blocks.z) continue;
      uint bits = bitsOfBlock(blockWord(uvec2(x, y)));
      some |= bits;
      all = all && bits != 0u;
    }
  return Material(some != 0u, all);
}

// The blocks and those around them.
ivec4 withNeighbors(ivec4 blocks) {
  return ivec4(max(blocks.xy - 1, ivec2(0)), min(blocks.zw + 1, ivec2(frame.blocks.xy)));
}

// Marks a block that has material or lies beside one that has.
void markNear(uint index) {
  ivec2 block = ivec2(index % frame.blocks.x, index / frame.blocks.x);
  writeTileWord(frame.blocks.z + index, materialOfBlocks(withNeighbors(ivec4(block, block + 1))).some ? 1u : 0u);
}

#endif
