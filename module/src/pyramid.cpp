#include "pyramid.h"

#include <algorithm>

namespace pellucid {
namespace {

// Texels of a level under `pixels` in a row from 0 on, and one more on each side.
uint32_t most(uint32_t pixels, uint32_t level) { return ((pixels - 1) >> level) + 3; }

// Columns that level 1 takes, and in its place level 2 after upsampling beside its shares.
uint32_t firstColumns(uint32_t pixels) { return std::max(most(pixels, kFirstLevel), 2 * most(pixels, 2)); }

}  // namespace

Pyramid::Pyramid(glm::uvec2 extent, const Rect& r) : coarsest(kFirstLevel + 2) {
  while (coarsest < PELLUCID_LAST_LEVEL && std::max(extent.x, extent.y) >> coarsest > 1)
    coarsest += 2;
  for (uint32_t level = kFirstLevel; level <= PELLUCID_LAST_LEVEL; ++level) {
    PyramidPlace& place = levels[level];
    // The second level of an image lies beside the first.
    if (level > kFirstLevel && level % 2 != 0)
      place.x = static_cast<int32_t>(most(extent.x, level - 1));
    // The two coarsest levels lie below levels 2 and 3.
    if (level > 5) place.y = static_cast<int32_t>(most(extent.y, 2));
    const int32_t border = level > kFirstLevel ? 1 : 0;
    const auto first = [&](uint32_t pixel) { return static_cast<int32_t>(pixel >> level) - border; };
    const auto end = [&](uint32_t pixels) {
      return static_cast<int32_t>((pixels - 1) >> level) + 1 + border;
    };
    place.rect = {first(r.x), first(r.y), end(r.x + r.width) - first(r.x), end(r.y + r.height) - first(r.y)};
  }
  sharesColumn = levels[2].rect.width;
  images[0] = {firstColumns(extent.x), most(extent.y, kFirstLevel)};
  for (uint32_t i = 1; i < kPyramidImages; ++i)
    images[i] = {most(extent.x, 2 * i) + most(extent.x, 2 * i + 1), most(extent.y, 2 * i)};
  images[1].height += most(extent.y, 6);
}

}  // namespace pellucid
