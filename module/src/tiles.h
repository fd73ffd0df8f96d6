// Tile lists say which groups of each pass have material to work on, as the GPU finds it (compute/tiles/).
// This file says where the groups lie and where the lists are kept.
#pragma once

#include <array>
#include <cstdint>

#include "pellucid/pellucid.h"
#include "pyramid.h"
#include "rect.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct FrameFacts;

// True where passes are to run over lists of groups with material.
inline bool asksForTileLists(const PellucidFrame& frame) {
  return frame.indirectDispatches == PELLUCID_INDIRECT_MATERIAL ||
         frame.indirectDispatches == PELLUCID_INDIRECT_CELLS;
}

// The groups of a pass. A group makes the part of the image that begins at `first` + its place * `step`,
// `size` pixels; parts that others read are larger by as much as that takes.
struct GroupGrid {
  uint32_t columns = 0, rows = 0;
  std::array<int32_t, 2> first{}, step{}, size{};  // pixels
  uint32_t runs = PELLUCID_RUNS_WITH_CELLS;
  uint32_t rowsEach = 1;  // rows of groups that its list holds as one

  uint32_t listedRows() const { return parts(rows, rowsEach); }
  uint32_t listed() const { return columns * listedRows(); }  // at most
};

// By PELLUCID_LIST_*; entry points have none.
using GroupGrids = std::array<GroupGrid, PELLUCID_LISTS>;
GroupGrids groupGrids(const FrameFacts& facts, const Rect& rect, const Pyramid& pyramid);

struct TileLists {
  std::array<uint32_t, 2> firstPixel{}, blocks{};
  std::array<uint32_t, PELLUCID_LISTS> first{};       // words of the lists
  std::array<uint32_t, PELLUCID_LISTS> firstGroup{};  // of the pass that makes the lists, by list
  uint32_t maps = 0;                                  // shadow maps that are gathered from
  uint32_t marks = 0;                                 // first word of the blocks' marks
  uint32_t words = 0, groups = 0;                     // in all; groups of the pass that makes the lists

  TileLists() = default;
  TileLists(const FrameFacts& facts, const Rect& rect, const GroupGrids& grids);

  static constexpr uint32_t kColumns = 1u << PELLUCID_TILE_WORDS_SHIFT;  // of the image that holds the words
};

// Why the frame's passes run over whole images in place of lists, or nullptr. Static string.
const char* whyNoTileLists(const FrameFacts& facts);

}  // namespace pellucid
