// Where the levels of the diffusion pyramid lie in its image. Level 1 is at the left, the coarser ones are
// below each other beside it.
#pragma once

#include <array>

#include "rect.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

constexpr uint32_t kFirstLevel = 1;

struct PyramidPlace {
  int32_t x, y;  // in the image
  struct {
    int32_t x, y, width, height;
  } rect;  // texels of the level that the render rect needs, as levelRect of compute/diffusion/texel.glsl
};

struct Pyramid {
  Pyramid() = default;
  Pyramid(const uint32_t (&imageExtent)[2], const Rect& rect);

  // The coarsest level in use: odd, because a dispatch that downsamples makes two levels, and no coarser than
  // it takes for the image to lie on 2 x 2 texels.
  uint32_t coarsest = 0;

  // By level, from kFirstLevel on; coarser levels than those in use have places, too.
  std::array<PyramidPlace, PELLUCID_LAST_LEVEL + 1> levels{};

  // The column where the shares of level 2 begin after upsampling. That level lies where level 1 was.
  int32_t sharesColumn = 0;

  // Of the pyramid's image, for any render rect.
  uint32_t width = 0, height = 0;

  // Texels of a level that the rect needs.
  uint64_t texels(uint32_t level) const {
    return static_cast<uint64_t>(levels[level].rect.width) * static_cast<uint64_t>(levels[level].rect.height);
  }
};

}  // namespace pellucid
