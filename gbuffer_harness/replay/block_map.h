// Blocks of a frame by what the device found there, for people to look at.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace pellucid::harness {

// Why a plan has no lists of blocks, in the words of its skips.
std::string whyNoLists(const PellucidPlan& plan);

// The material that the device found in a block, which decides which passes run there.
enum class BlockClass : std::uint8_t {
  Empty,    // none: only the base level and the pass of the lists run
  Near,     // none, but a block beside it has material: the pyramid's passes run
  Material  // some: all passes run
};
inline constexpr std::size_t kBlockClasses = 3;

struct BlockClassText {
  const char *color, *text;  // name of `srgb`; what the class says
  std::array<std::uint8_t, 3> srgb;
};

// The colors are those of Okabe and Ito, which color-blind people tell apart.
const BlockClassText& textOf(BlockClass block);

struct BlockMap {
  int x = 0, y = 0;                // first pixel of the first block
  int columns = 0, rows = 0;       // blocks that the rect touches
  std::array<int, 4> rect{};       // pixels: x, y, end x, end y
  std::vector<BlockClass> blocks;  // row by row

  std::array<std::uint64_t, kBlockClasses> counts() const;  // of blocks, by class
};

// The map of the last recording, which the device has finished. Throws InputError with the reason where the
// frame has no lists.
BlockMap readBlockMap(const FrameRun& run);

// Draws the classes over a picture of the frame, `width` x `height` pixels of three bytes: each block's first
// row and column of pixels have its class's color, and the others a third of it. Pixels outside the rect
// stay.
void drawBlockMap(const BlockMap& map, int width, int height, std::vector<std::uint8_t>& srgb);

// The classes that the map has, with their colors and counts; lines of text.
std::string blockLegend(const BlockMap& map);

}  // namespace pellucid::harness
