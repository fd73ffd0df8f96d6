#include "pyramid.h"

#include <algorithm>

namespace pellucid {
namespace {

// Texels of a level under `pixels` in a row, wherever they start, and one more on each side.
uint32_t most(uint32_t pixels, uint32_t level) { return ((pixels - 1) >> level) + 3; }

// What level 1 takes in a row, and in its place the resolved level 2 beside its shares.
uint32_t firstColumns(uint32_t pixels) { return std::max(most(pixels, kFirstLevel), 2 * most(pixels, 2)); }

}  // namespace

uint32_t coarsestLevel(const PellucidFrame& frame) {
  uint32_t level = kFirstLevel + 2;
  while (level < PELLUCID_LAST_LEVEL && std::max(frame.imageExtent[0], frame.imageExtent[1]) >> level > 1)
    level += 2;
  return level;
}

PyramidPlace placeOf(const PellucidFrame& frame, uint32_t level) {
  PyramidPlace place{};
  if (level > kFirstLevel) place.x = static_cast<int32_t>(firstColumns(frame.imageExtent[0]));
  for (uint32_t l = kFirstLevel + 1; l < level; ++l)
    place.y += static_cast<int32_t>(most(frame.imageExtent[1], l));
  const Rect r = renderRect(frame);
  const int32_t border = level > kFirstLevel ? 1 : 0;
  const auto first = [&](uint32_t pixel) { return static_cast<int32_t>(pixel >> level) - border; };
  const auto end = [&](uint32_t pixels) { return static_cast<int32_t>((pixels - 1) >> level) + 1 + border; };
  place.rect = {first(r.x), first(r.y), end(r.x + r.width) - first(r.x), end(r.y + r.height) - first(r.y)};
  return place;
}

int32_t sharesColumn(const PellucidFrame& frame) { return placeOf(frame, 2).rect.width; }

PyramidExtent pyramidExtent(const PellucidFrame& frame) {
  uint32_t height = 0;
  for (uint32_t l = kFirstLevel + 1; l <= coarsestLevel(frame); ++l) height += most(frame.imageExtent[1], l);
  return {firstColumns(frame.imageExtent[0]) + most(frame.imageExtent[0], 2),
          std::max(height, most(frame.imageExtent[1], kFirstLevel))};
}

}  // namespace pellucid
