#include "tiles.h"

#include <algorithm>

#include "entry_points.h"
#include "frame.h"

namespace pellucid {
namespace {

// The least limit of workgroups along an axis, of all devices.
constexpr uint32_t kMostGroups = 65535;
// No pass has as many groups in images of so many pixels: the smallest do 8 x 8.
constexpr uint64_t kFewPixels = 1u << 21;
constexpr uint32_t kMostLightGroups = 8;  // leaves room for the lists' dispatches in any plan

// A bit for each of a map's groups of entry points.
static_assert(kEntryColumns / PELLUCID_ENTRY_POINTS_GROUP * (kEntryColumns / PELLUCID_ENTRY_POINTS_GROUP) <=
              32 * PELLUCID_ENTRY_GROUP_WORDS);

// Parts of `side` pixels from the first pixel on.
GroupGrid gridFrom(std::array<int32_t, 2> first, uint32_t columns, uint32_t rows, int32_t width,
                   int32_t height) {
  return {columns, rows, first, {width, height}, {width, height}};
}

GroupGrid grown(GroupGrid grid, int32_t x, int32_t y) {
  grid.first = {grid.first[0] - x, grid.first[1] - y};
  grid.size = {grid.size[0] + 2 * x, grid.size[1] + 2 * y};
  return grid;
}

GroupGrid tileGrid(const Rect& r) {
  return gridFrom({static_cast<int32_t>(r.x & ~1u), static_cast<int32_t>(r.y & ~1u)},
                  parts(r.width + (r.x & 1), PELLUCID_TILE), parts(r.height + (r.y & 1), PELLUCID_TILE),
                  PELLUCID_TILE, PELLUCID_TILE);
}

// Groups make PELLUCID_DOWNSAMPLE_TILE texels of the coarser of two levels.
GroupGrid downsampleGrid(const Pyramid& pyramid, uint32_t coarser) {
  const auto& rect = pyramid.levels[coarser].rect;
  const int32_t side = PELLUCID_DOWNSAMPLE_TILE << coarser, first = 1 << coarser;
  return gridFrom({rect.x * first, rect.y * first},
                  parts(static_cast<uint32_t>(rect.width), PELLUCID_DOWNSAMPLE_TILE),
                  parts(static_cast<uint32_t>(rect.height), PELLUCID_DOWNSAMPLE_TILE), side, side);
}

// Groups start at texels 32 k - 1 of level 2, in y 16 k - 1.
GroupGrid upsampleGrid(const Pyramid& pyramid) {
  const auto& rect = pyramid.levels[2].rect;
  constexpr int32_t kWidth = 2 * PELLUCID_UPSAMPLE_GROUP, kHeight = PELLUCID_UPSAMPLE_GROUP;
  // Shifts round down, below 0, too.
  const int32_t x = (rect.x + 1) >> 5, y = (rect.y + 1) >> 4;
  static_assert(kWidth == 32 && kHeight == 16);
  const auto count = [](int32_t first, int32_t texels, int32_t side, int32_t from) {
    return static_cast<uint32_t>((first + texels) / side - from + 1);
  };
  return gridFrom({4 * (kWidth * x - 1), 4 * (kHeight * y - 1)}, count(rect.x, rect.width, kWidth, x),
                  count(rect.y, rect.height, kHeight, y), 4 * kWidth, 4 * kHeight);
}

// Groups start at texels of level 2, whose rect has a border of one.
GroupGrid diffuseGrid(const Pyramid& pyramid, bool fine) {
  const auto& rect = pyramid.levels[2].rect;
  const uint32_t x = fine ? PELLUCID_DIFFUSE_TEXELS_X : PELLUCID_DIFFUSE_COARSE_TEXELS_X;
  constexpr uint32_t y = PELLUCID_DIFFUSE_TEXELS_Y;
  return gridFrom({4 * (rect.x + 1), 4 * (rect.y + 1)}, parts(static_cast<uint32_t>(rect.width) - 2, x),
                  parts(static_cast<uint32_t>(rect.height) - 2, y), static_cast<int32_t>(4 * x),
                  static_cast<int32_t>(4 * y));
}

// Groups of `side` x `side` cells of the gather's probes.
GroupGrid cellGrid(const Rect& r, uint32_t spacing, uint32_t side) {
  const auto first = [&](uint32_t pixel) { return static_cast<int32_t>(pixel / spacing * spacing); };
  const auto pixels = static_cast<int32_t>(side * spacing);
  return gridFrom({first(r.x), first(r.y)}, parts(cellsAlong(r.x, r.width, spacing), side),
                  parts(cellsAlong(r.y, r.height, spacing), side), pixels, pixels);
}

GroupGrid running(uint32_t runs, GroupGrid grid) {
  grid.runs = runs;
  return grid;
}

GroupGrids gridsOf(const FrameFacts& f, const Rect& rect, const Pyramid& pyramid) {
  const auto spacing = static_cast<int32_t>(f.gatherSpacing);
  GroupGrids grids;
  grids[PELLUCID_LIST_TILES] = tileGrid(rect);
  // A group reads three texels of level 1 around its part.
  grids[PELLUCID_LIST_DOWNSAMPLE] =
      running(PELLUCID_RUNS_BESIDE_BLOCKS, grown(downsampleGrid(pyramid, 3), 6, 6));
  grids[PELLUCID_LIST_DOWNSAMPLE_COARSE] = running(PELLUCID_RUNS_WITH_ANY, downsampleGrid(pyramid, 5));
  // As far as a group that diffuses reads around one of its pixels: all of its part but that, and a texel of
  // level 2.
  grids[PELLUCID_LIST_UPSAMPLE] = running(
      PELLUCID_RUNS_WITH_BLOCKS, grown(upsampleGrid(pyramid), 4 * PELLUCID_DIFFUSE_COARSE_TEXELS_X + 4,
                                       4 * PELLUCID_DIFFUSE_TEXELS_Y + 4));
  grids[PELLUCID_LIST_DIFFUSE] = diffuseGrid(pyramid, kQualities[f.quality].fineFilter);
  // A pixel reads the next cell's filtered probe, which is of the probes three cells around.
  grids[PELLUCID_LIST_PROBES] =
      grown(cellGrid(rect, f.gatherSpacing, PELLUCID_PROBES_GROUP), 5 * spacing, 5 * spacing);
  grids[PELLUCID_LIST_FILTER_PROBES] =
      grown(cellGrid(rect, f.gatherSpacing, PELLUCID_FILTER_GROUP), 2 * spacing, 2 * spacing);
  return grids;
}

// As few rows of a list as let its groups lie in a row.
uint32_t rowsEach(const GroupGrid& grid) {
  return parts(grid.rows, std::max(kMostGroups / std::max(grid.columns, 1u), 1u));
}

}  // namespace

GroupGrids groupGrids(const FrameFacts& f, const Rect& rect, const Pyramid& pyramid) {
  GroupGrids grids = gridsOf(f, rect, pyramid);
  // The whole image decides, so that no rect needs more words than its lists have.
  const Rect all{0, 0, f.frame.imageExtent[0], f.frame.imageExtent[1]};
  if (uint64_t{all.width} * all.height <= kFewPixels) return grids;
  const GroupGrids whole = gridsOf(f, all, Pyramid(f.frame.imageExtent, all));
  for (uint32_t list = 0; list < PELLUCID_LIST_ENTRY_POINTS; ++list)
    grids[list].rowsEach = rowsEach(whole[list]);
  return grids;
}

TileLists::TileLists(const FrameFacts& f, const Rect& rect, const GroupGrids& grids)
    : firstPixel{rect.x & ~1u, rect.y & ~1u},
      blocks{parts(rect.x + rect.width - firstPixel[0], PELLUCID_BLOCK),
             parts(rect.y + rect.height - firstPixel[1], PELLUCID_BLOCK)},
      maps(f.stages.gathered > 0 ? f.lights.list().front().shadowCount : 0) {
  constexpr uint32_t kInvocations = PELLUCID_LIST_GROUP * PELLUCID_LIST_GROUP;
  const uint32_t blockCount = blocks[0] * blocks[1];
  marks = PELLUCID_BLOCK_WORDS * blockCount;
  words = marks + blockCount;
  for (uint32_t list = 0; list < PELLUCID_LIST_ENTRY_POINTS; ++list) {
    const uint32_t count = list < PELLUCID_LIST_PROBES || f.stages.gathered > 0 ? grids[list].listed() : 0;
    first[list] = words;
    words += count;
    firstGroup[list] = groups;
    groups += parts(count, kInvocations);
  }
  first[PELLUCID_LIST_ENTRY_POINTS] = words;
  words += f.lights.entryColumns * f.lights.entryRows /
           (PELLUCID_ENTRY_POINTS_GROUP * PELLUCID_ENTRY_POINTS_GROUP);
  firstGroup[PELLUCID_LIST_ENTRY_POINTS] = groups;
  // An invocation for each block's mark, then for each map, block and row of the map's groups.
  constexpr uint32_t kRows = kEntryColumns / PELLUCID_ENTRY_POINTS_GROUP;
  groups += parts(blockCount * (1 + kRows * maps), kInvocations);
}

const char* whyNoTileLists(const FrameFacts& f) {
  if (!asksForTileLists(f.frame)) return "frame.indirectDispatches asks for none";
  if (f.stages.history) return "frame.reuse keeps the light of pixels, all of which it writes";
  if (f.lights.count > kMostLightGroups || f.stages.gathered > 1) return "lights need several dispatches";
  const auto isTooLarge = [](const GroupGrid& grid) {
    return grid.columns > PELLUCID_GROUP_COLUMN || grid.listed() > kMostGroups;
  };
  if (std::any_of(f.grids.begin(), f.grids.end(), isTooLarge) ||
      TileLists(f, f.rect, f.grids).groups > kMostGroups)
    return "the image has more groups than lists can hold";
  return nullptr;
}

}  // namespace pellucid
