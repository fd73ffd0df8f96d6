// Blocks of 64 x 64 pixels of the image. base_level.comp finds which of them hold material and lists these;
// later passes do one listed block, or a part of it, a group.
//
// The image of words holds PELLUCID_BLOCK_WORDS a block, row by row, and then three lists of words: blocks with material or
// beside one, blocks with material, and groups of entry points.
#ifndef PELLUCID_BLOCKS_GLSL
#define PELLUCID_BLOCKS_GLSL

#include "frame/frame.glsl"

layout(set = 0, binding = PELLUCID_BINDING_BLOCKS, r32ui) uniform uimage2D blocksImage;

const int kBlockShift = 6, kCellShift = 3; // of PELLUCID_BLOCK and PELLUCID_CELL
// Words of a block: two with a bit for each cell of 8 x 8 pixels, rows 0 to 3 and 4 to 7; 1 if the block or one beside it has
// material.
const uint kCellWord = 0u, kNearWord = 2u;

ivec2 wordPlace(uint word) {
  return ivec2(word & ((1u << PELLUCID_BLOCK_WORDS_SHIFT) - 1u), word >> PELLUCID_BLOCK_WORDS_SHIFT);
}
uint readWord(uint word) { return imageLoad(blocksImage, wordPlace(word)).x; }
void writeWord(uint word, uint value) { imageStore(blocksImage, wordPlace(word), uvec4(value)); }

uint blockCount() { return frame.blocks.x * frame.blocks.y; }
uint blockWord(uint block, uint word) { return uint(PELLUCID_BLOCK_WORDS) * block + word; }
// Blocks reach as far as texels of levels 2 and 3 that the rect needs: their border holds what filters carry over the rect's edge.
ivec2 firstBlock() { return (ivec2(frame.rect.xy) - PELLUCID_BLOCK_BORDER) >> kBlockShift; }
ivec2 firstPixel(uint block) {
  return (firstBlock() + ivec2(block % frame.blocks.x, block / frame.blocks.x)) << kBlockShift;
}

// First words of the lists of blocks with material or beside one, of blocks with material, and of groups of entry points.
uint nearList() { return frame.blocks.z; }
uint materialList() { return frame.blocks.z + blockCount(); }
uint entryList() { return frame.blocks.z + 2u * blockCount(); }

// Without lists all groups run.
bool goesByLists() { return frame.blocks.w != 0u; }

// The word of the work group's block, whose x counts blocks. `list`: its first word. Lists are read as far as their commands
// count, so that words hold what base_level.comp wrote.
uint listedBlock(uint list) { return goesByLists() ? readWord(list + gl_WorkGroupID.x) : gl_WorkGroupID.x; }

// A listed group of entry points.
struct EntryGroup {
  uvec2 at; // column and row among the groups of its level, which are at most 64 x 64
  uint level, map;
};

uint packEntryGroup(EntryGroup group) { return group.at.x | group.at.y << 8 | group.level << 16 | group.map << 24; }
EntryGroup unpackEntryGroup(uint word) {
  return EntryGroup(uvec2(word & 0xFFu, word >> 8 & 0xFFu), word >> 16 & 0xFFu, word >> 24);
}

uint cellWord(ivec2 cell) { return kCellWord + uint(cell.y >> 2); }
uint cellBit(ivec2 cell) { return 1u << (8 * (cell.y & 3) + cell.x); }

// True where the pixel's cell holds material: what earlier passes wrote for the pixel holds something. `pixel`: of the rect or at most
// PELLUCID_BLOCK_BORDER from it.
bool cellHoldsMaterial(ivec2 pixel) {
  ivec2 block = (pixel >> kBlockShift) - firstBlock(), cell = (pixel & (PELLUCID_BLOCK - 1)) >> kCellShift;
  return (readWord(blockWord(uint(block.y) * frame.blocks.x + uint(block.x), cellWord(cell))) & cellBit(cell)) != 0u;
}

// True where the pixel's block or one beside it holds material: levels 2 and 3 of the pyramid hold something. `pixel`: of the rect
// or at most PELLUCID_BLOCK_BORDER from it.
bool isNearMaterial(ivec2 pixel) {
  if (!goesByLists()) return true;
  ivec2 block = (pixel >> kBlockShift) - firstBlock();
  return readWord(blockWord(uint(block.y) * frame.blocks.x + uint(block.x), kNearWord)) != 0u;
}

// A bit of a listed block's word: all cells of the block and of the blocks around hold material, so that everything that passes
// read there has been written. Without the bit close-ups take up to 4 % longer.
const uint kWholeBlock = 0x80000000u;
bool isWhole(uint word) { return (word & kWholeBlock) != 0u; }
uint blockOf(uint word) { return word & ~kWholeBlock; }

// The first pixel of the group's part of a block: y of the work group counts the parts, of `pixels` each. `word`: a block's number, or
// a listed word. False, alike in all invocations, where no cell of the part holds material.
bool materialPart(uint word, ivec2 pixels, out ivec2 first) {
  uint block = blockOf(word);
  int columns = PELLUCID_BLOCK / pixels.x, index = int(gl_WorkGroupID.y);
  ivec2 part = pixels * ivec2(index % columns, index / columns), cell = part >> kCellShift, end = cell + (pixels >> kCellShift);
  first = firstPixel(block) + part;
  if (isWhole(word)) return true;
  uint inRows = ((1u << end.x) - (1u << cell.x)) * 0x01010101u, some = 0u; // columns [cell.x, end.x) of four rows
  for (int row = cell.y; row < end.y; ++row)
    some |= readWord(blockWord(block, cellWord(ivec2(0, row)))) & inRows & 255u << 8 * (row & 3);
  return some != 0u;
}

// The part that materialPart finds in the listed block of the group.
bool materialPart(ivec2 pixels, out ivec2 first) { return materialPart(listedBlock(materialList()), pixels, first); }

#endif
