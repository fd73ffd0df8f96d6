// Tiles of a frame by what the device found and ran there, for people to look at.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace pellucid::harness {

// Why a plan has no tile lists, in the words of its skips.
std::string whyNoTileLists(const PellucidPlan& plan);

// Bits of a tile.
inline constexpr unsigned kTileDiffuses = 1;  // a group of the diffusion's last pass has pixels of it
inline constexpr unsigned kTileProbes = 2;    // a group of the gather's probes has pixels of it
inline constexpr unsigned kTileMaterial = 4;  // it has a material
inline constexpr unsigned kTileClasses = 8;   // combinations of these

struct TileClass {
  const char *color, *text;  // name of `srgb`; what the class says
  std::array<std::uint8_t, 3> srgb;
};

// `bits`: below kTileClasses. The colors are those of Okabe and Ito, which color-blind people tell apart.
const TileClass& tileClass(unsigned bits);

struct TileMap {
  int x = 0, y = 0;            // first pixel of the first tile
  int columns = 0, rows = 0;   // tiles that the rect touches
  std::array<int, 4> rect{};   // pixels: x, y, end x, end y
  std::vector<unsigned> bits;  // of each tile, row by row
  // Listed groups of 16 x 16 entry points of each shadow map that is gathered from, in the order of the
  // lights' maps; empty without a gather.
  std::vector<std::uint64_t> entryGroups;

  std::array<std::uint64_t, kTileClasses> counts() const;  // of tiles, by class
};

// The map of the last recording, which the device has finished. Throws InputError with the reason where the
// frame has no tile lists.
TileMap readTileMap(const FrameRun& run);

// Draws the classes over a picture of the frame, `width` x `height` pixels of three bytes: each tile's first
// row and column of pixels have its class's color, and the others a third of it. Pixels outside the rect
// stay.
void drawTileMap(const TileMap& map, int width, int height, std::vector<std::uint8_t>& srgb);

// The classes that the map has, with their colors and counts, and the entry points; lines of text.
std::string tileLegend(const TileMap& map);

}  // namespace pellucid::harness
