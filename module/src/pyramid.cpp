#include "pyramid.h"

#include <algorithm>

namespace pellucid {
namespace {

// Texels of a level under `pixels` in a row from 0 on, and one more on each side.
uint32_t most(uint32_t pixels, uint32_t level) { return ((pixels - 1) >> level) + 3; }

}  // namespace

Pyramid::Pyramid(glm::uvec2 extent, const Rect& r) : coarsest(kFirstLevel + 2) {
  while (coarsest < PELLUCID_LAST_LEVEL && std::max(extent.x, extent.y) >> coarsest > 1)
    coarsest += 2;
  for (uint32_t level = kFirstLevel; level <= PELLUCID_LAST_LEVEL; ++level) {
    PyramidPlace& place = levels[level];
    Extent& image = images[imageOfLevel(level)];
    place.column = static_cast<int32_t>(image.width);
    image.width += most(extent.x, level);
    image.height = std::max(image.height, most(extent.y, level));
    const int32_t border = level > kFirstLevel ? 1 : 0;
    const auto first = [&](uint32_t pixel) { return static_cast<int32_t>(pixel >> level) - border; };
    const auto end = [&](uint32_t pixels) {
      return static_cast<int32_t>((pixels - 1) >> level) + 1 + border;
    };
    place.rect = {first(r.x), first(r.y), end(r.x + r.width) - first(r.x), end(r.y + r.height) - first(r.y)};
  }
  // In place of level 1, level 2 after upsampling lies beside its shares.
  sharesColumn = levels[2].rect.width;
  images[0].width = std::max(images[0].width, 2 * most(extent.x, 2));
}

}  // namespace pellucid
