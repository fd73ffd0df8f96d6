#include "replay/block_map.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <span>
#include <utility>

#include "common/error.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {
namespace {

constexpr int kBlock = PELLUCID_BLOCK;

// Words of a block, as compute/frame/blocks.glsl has them. The first two have bits of cells with material.
// The last one is 1 if the block or a block beside it has material.
constexpr std::size_t kCellWords[] = {0, 1}, kNearWord = 2;

BlockClass classOf(std::span<const std::uint32_t> words) {
  if (words[kCellWords[0]] != 0 || words[kCellWords[1]] != 0) return BlockClass::Material;
  return words[kNearWord] != 0 ? BlockClass::Near : BlockClass::Empty;
}

}  // namespace

std::string whyNoLists(const PellucidPlan& plan) {
  for (const auto& [what, before] : {std::pair{"lists", ""}, {"diffusion", "nothing diffuses: "}})
    for (std::uint32_t i = 0; i < plan.skipCount; ++i)
      if (std::strcmp(plan.skips[i].what, what) == 0) return std::string(before) + plan.skips[i].reason;
  return "frame.options.indirectDispatches asks for none";
}

const BlockClassText& textOf(BlockClass block) {
  static constexpr BlockClassText kTexts[kBlockClasses] = {
      {"black", "no material", {0, 0, 0}},
      {"blue", "no material, beside some: the diffusion's pyramid runs", {0, 114, 178}},
      {"yellow", "material: all passes run", {240, 228, 66}}};
  return kTexts[static_cast<std::size_t>(block)];
}

std::array<std::uint64_t, kBlockClasses> BlockMap::counts() const {
  std::array<std::uint64_t, kBlockClasses> all{};
  for (const BlockClass block : blocks) ++all[static_cast<std::size_t>(block)];
  return all;
}

BlockMap readBlockMap(const FrameRun& run) {
  if (!run.statistics().lists)
    throw InputError(run.name(), "", "has no lists of blocks to draw: " + whyNoLists(run.plan()));
  const PellucidFrame& frame = run.frame();
  BlockMap map;
  const std::array<int, 2> extent = {static_cast<int>(frame.imageExtent[0]),
                                     static_cast<int>(frame.imageExtent[1])};
  map.rect = {0, 0, extent[0], extent[1]};
  if (frame.options.renderRect[2] > 0)
    for (std::size_t i = 0; i < 2; ++i) {
      map.rect[i] = static_cast<int>(frame.options.renderRect[i]);
      map.rect[2 + i] = map.rect[i] + static_cast<int>(frame.options.renderRect[2 + i]);
    }
  map.x = map.rect[0] / kBlock * kBlock;
  map.y = map.rect[1] / kBlock * kBlock;
  map.columns = (map.rect[2] - map.x + kBlock - 1) / kBlock;
  map.rows = (map.rect[3] - map.y + kBlock - 1) / kBlock;
  // The words have blocks beyond the rect, too, where the pyramid's border touches them.
  // Rounds down, from -kBlock on.
  const auto blockOf = [](int pixel) { return (pixel + kBlock) / kBlock - 1; };
  const int left = blockOf(map.rect[0] - PELLUCID_BLOCK_BORDER),
            top = blockOf(map.rect[1] - PELLUCID_BLOCK_BORDER);
  const int pitch = blockOf(map.rect[2] - 1 + PELLUCID_BLOCK_BORDER) - left + 1;
  const std::vector<std::uint32_t> words = run.blockWords();
  for (int y = 0; y < map.rows; ++y)
    for (int x = 0; x < map.columns; ++x) {
      const auto block =
          static_cast<std::size_t>((map.y / kBlock + y - top) * pitch + map.x / kBlock + x - left);
      map.blocks.push_back(
          classOf(std::span(words).subspan(PELLUCID_BLOCK_WORDS * block, PELLUCID_BLOCK_WORDS)));
    }
  return map;
}

void drawBlockMap(const BlockMap& map, int width, int height, std::vector<std::uint8_t>& srgb) {
  for (int y = map.rect[1]; y < std::min(map.rect[3], height); ++y)
    for (int x = map.rect[0]; x < std::min(map.rect[2], width); ++x) {
      const int column = (x - map.x) / kBlock, row = (y - map.y) / kBlock;
      const bool border = x % kBlock == 0 || y % kBlock == 0;
      const BlockClassText& text = textOf(map.blocks[static_cast<std::size_t>(row * map.columns + column)]);
      std::uint8_t* pixel = &srgb[3 * static_cast<std::size_t>(y * width + x)];
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = border ? text.srgb[c] : static_cast<std::uint8_t>((2 * pixel[c] + text.srgb[c]) / 3);
    }
}

std::string blockLegend(const BlockMap& map) {
  char line[128];
  std::snprintf(line, sizeof line, "%-10s %8s  class, of %d x %d blocks of %d x %d pixels\n", "color",
                "blocks", map.columns, map.rows, kBlock, kBlock);
  std::string text = line;
  const auto counts = map.counts();
  for (std::size_t i = 0; i < kBlockClasses; ++i) {
    if (counts[i] == 0) continue;
    const BlockClassText& of = textOf(static_cast<BlockClass>(i));
    std::snprintf(line, sizeof line, "%-10s %8llu  %s\n", of.color,
                  static_cast<unsigned long long>(counts[i]), of.text);
    text += line;
  }
  return text;
}

}  // namespace pellucid::harness
