#include "replay/tile_map.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <utility>

#include "common/error.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {
namespace {

struct Group {
  int x, y;
};
Group groupIn(std::uint32_t word) {
  return {static_cast<int>(word & PELLUCID_GROUP_COLUMN), static_cast<int>(word >> PELLUCID_GROUP_ROW_SHIFT)};
}
std::size_t mapIn(std::uint32_t word) { return word >> PELLUCID_GROUP_MAP_SHIFT; }

const PellucidDispatch* dispatchOf(const PellucidPlan& plan, const char* name) {
  const auto* end = plan.dispatches + plan.dispatchCount;
  const auto* found = std::find_if(
      plan.dispatches, end, [name](const PellucidDispatch& d) { return std::strcmp(d.name, name) == 0; });
  return found == end ? nullptr : found;
}

// The slice's constants that say where the lists and the groups' parts of the image lie.
struct Layout {
  shared::FrameConstants frame;
  shared::TileCommands tiles;

  // `base`: the dispatch that goes by the list of tiles.
  Layout(const void* slice, const PellucidDispatch& base) {
    const auto* bytes = static_cast<const char*>(slice);
    std::size_t frameOffset = 0;
    for (std::uint32_t i = 0; i < base.bindingCount; ++i)
      if (base.bindings[i].binding == PELLUCID_BINDING_FRAME)
        frameOffset = static_cast<std::size_t>(base.bindings[i].offset);
    constexpr std::size_t kCommand =
        offsetof(shared::TileCommands, commands) + PELLUCID_LIST_TILES * sizeof(shared::uvec4);
    std::memcpy(static_cast<void*>(&frame), bytes + frameOffset, sizeof frame);
    std::memcpy(static_cast<void*>(&tiles), bytes + static_cast<std::size_t>(base.indirectOffset) - kCommand,
                sizeof tiles);
  }

  std::uint32_t firstWord(std::uint32_t list) const { return frame.lists[list / 4][list % 4]; }
};

// Marks the tiles that hold pixels of a group: of the part that it makes, not of all that it reads.
void mark(TileMap& map, const shared::GroupList& groups, Group at, unsigned bit) {
  const auto tiles = [](int first, int end, int count) {
    return std::array{std::clamp(first / PELLUCID_TILE, 0, count),
                      std::clamp((end + PELLUCID_TILE - 1) / PELLUCID_TILE, 0, count)};
  };
  const int stepX = groups.places.z, stepY = groups.places.w;
  const int x = groups.places.x + at.x * stepX + (groups.size.x - stepX) / 2;
  const int y = groups.places.y + at.y * stepY + (groups.size.y - stepY) / 2;
  const auto [left, right] = tiles(std::max(x, 0), std::max(x + stepX, 0), map.columns);
  const auto [top, bottom] = tiles(std::max(y, 0), std::max(y + stepY, 0), map.rows);
  for (int row = top; row < bottom; ++row)
    for (int column = left; column < right; ++column)
      map.bits[static_cast<std::size_t>(row * map.columns + column)] |= bit;
}

}  // namespace

std::string whyNoTileLists(const PellucidPlan& plan) {
  for (const auto& [what, before] : {std::pair{"tile lists", ""}, {"diffusion", "nothing diffuses: "}})
    for (std::uint32_t i = 0; i < plan.skipCount; ++i)
      if (std::strcmp(plan.skips[i].what, what) == 0) return std::string(before) + plan.skips[i].reason;
  return "frame.indirectDispatches asks for none";
}

const TileClass& tileClass(unsigned bits) {
  static constexpr TileClass kClasses[kTileClasses] = {
      {"black", "no material", {0, 0, 0}},
      {"blue", "no material, in a group that diffuses", {0, 114, 178}},
      {"purple", "no material, in a group of probes", {204, 121, 167}},
      {"vermilion", "no material, in groups that diffuse and of probes", {213, 94, 0}},
      {"yellow", "material", {240, 228, 66}},
      {"sky blue", "material, diffuses", {86, 180, 233}},
      {"orange", "material, has probes", {230, 159, 0}},
      {"green", "material, has probes and diffuses", {0, 158, 115}}};
  static_assert(kTileDiffuses == 1 && kTileProbes == 2 && kTileMaterial == 4);
  return kClasses[bits % kTileClasses];
}

std::array<std::uint64_t, kTileClasses> TileMap::counts() const {
  std::array<std::uint64_t, kTileClasses> all{};
  for (const unsigned tile : bits) ++all[tile];
  return all;
}

TileMap readTileMap(const FrameRun& run) {
  const PellucidPlan& plan = run.plan();
  const PellucidStatistics statistics = run.statistics();
  if (!statistics.tileLists)
    throw InputError(run.name(), "", "has no tile lists to draw: " + whyNoTileLists(plan));
  const Layout layout(run.constants(), *dispatchOf(plan, "base level"));
  const std::vector<std::uint32_t> words = run.tileWords();
  // Groups of a list, each at `each(word)`. `count`: groups that ran, of all rows.
  const auto forEach = [&](std::uint32_t list, std::uint64_t count, auto&& each) {
    const std::uint32_t rows = std::max(layout.tiles.groups[list].count.z, 1u);
    for (std::uint64_t i = 0; i < count / rows; ++i) each(words.at(layout.firstWord(list) + i));
  };

  TileMap map;
  const shared::uvec4 rect = layout.frame.rect;
  for (int i = 0; i < 4; ++i) map.rect[static_cast<std::size_t>(i)] = static_cast<int>(rect[i]);
  // Tiles begin at even pixels.
  map.x = map.rect[0] & ~1;
  map.y = map.rect[1] & ~1;
  map.columns = (map.rect[2] - map.x + PELLUCID_TILE - 1) / PELLUCID_TILE;
  map.rows = (map.rect[3] - map.y + PELLUCID_TILE - 1) / PELLUCID_TILE;
  map.bits.resize(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows));
  forEach(PELLUCID_LIST_TILES, statistics.tiles.run, [&](std::uint32_t word) {
    mark(map, layout.tiles.groups[PELLUCID_LIST_TILES], groupIn(word), kTileMaterial);
  });
  forEach(PELLUCID_LIST_DIFFUSE, statistics.diffusion.run, [&](std::uint32_t word) {
    mark(map, layout.tiles.groups[PELLUCID_LIST_DIFFUSE], groupIn(word), kTileDiffuses);
  });
  forEach(PELLUCID_LIST_PROBES, statistics.probes.run, [&](std::uint32_t word) {
    mark(map, layout.tiles.groups[PELLUCID_LIST_PROBES], groupIn(word), kTileProbes);
  });
  if (statistics.entryPoints.most > 0) map.entryGroups.resize(layout.tiles.maps.x);
  forEach(PELLUCID_LIST_ENTRY_POINTS, statistics.entryPoints.run,
          [&](std::uint32_t word) { ++map.entryGroups.at(mapIn(word)); });
  return map;
}

void drawTileMap(const TileMap& map, int width, int height, std::vector<std::uint8_t>& srgb) {
  for (int y = map.rect[1]; y < std::min(map.rect[3], height); ++y)
    for (int x = map.rect[0]; x < std::min(map.rect[2], width); ++x) {
      const int column = (x - map.x) / PELLUCID_TILE, row = (y - map.y) / PELLUCID_TILE;
      const bool border = (x - map.x) % PELLUCID_TILE == 0 || (y - map.y) % PELLUCID_TILE == 0;
      const TileClass& tile = tileClass(map.bits[static_cast<std::size_t>(row * map.columns + column)]);
      std::uint8_t* pixel = &srgb[3 * static_cast<std::size_t>(y * width + x)];
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = border ? tile.srgb[c] : static_cast<std::uint8_t>((2 * pixel[c] + tile.srgb[c]) / 3);
    }
}

std::string tileLegend(const TileMap& map) {
  char line[128];
  std::snprintf(line, sizeof line, "%-10s %8s  class, of %d x %d tiles of %d x %d pixels\n", "color", "tiles",
                map.columns, map.rows, PELLUCID_TILE, PELLUCID_TILE);
  std::string text = line;
  const auto counts = map.counts();
  for (unsigned bits = 0; bits < kTileClasses; ++bits) {
    if (counts[bits] == 0) continue;
    std::snprintf(line, sizeof line, "%-10s %8llu  %s\n", tileClass(bits).color,
                  static_cast<unsigned long long>(counts[bits]), tileClass(bits).text);
    text += line;
  }
  for (std::size_t i = 0; i < map.entryGroups.size(); ++i) {
    std::snprintf(line, sizeof line, "entry points of map %zu: %llu groups of %d x %d\n", i,
                  static_cast<unsigned long long>(map.entryGroups[i]), PELLUCID_ENTRY_POINTS_GROUP,
                  PELLUCID_ENTRY_POINTS_GROUP);
    text += line;
  }
  return text;
}

}  // namespace pellucid::harness
