// Places of the levels of the diffusion pyramid in its images. No dispatch reads the image that it writes:
// level 1, levels 2 and 3, and levels 4 to 7 have one each, side by side. Upsampling writes over level 1.
#pragma once

#include <array>

#include "images.h"

namespace pellucid {

constexpr uint32_t kFirstLevel = 1, kPyramidImages = 3;
constexpr uint32_t imageOfLevel(uint32_t level) { return level < 2 ? 0 : level < 4 ? 1 : 2; }

struct PyramidPlace {
  int32_t column;  // the first one in the level's image
  struct {
    int32_t x, y, width, height;
  } rect;  // texels of the level that the render rect needs, as levelRect of compute/diffusion/texel.glsl
};

struct Pyramid {
  Pyramid() = default;
  Pyramid(glm::uvec2 extent, const Rect& rect);

  // The coarsest level in use: 3, 5 or 7, and no coarser than it takes for the image to lie on 2 x 2 texels.
  uint32_t coarsest = 0;

  // By level, from kFirstLevel on; coarser levels than those in use have places, too.
  std::array<PyramidPlace, PELLUCID_LAST_LEVEL + 1> levels{};

  // The column where the shares of level 2 begin after upsampling, in the image of level 1.
  int32_t sharesColumn = 0;

  // Extents of the images, for any render rect.
  std::array<Extent, kPyramidImages> images{};
};

}  // namespace pellucid
