// Places of the levels of the diffusion pyramid in its images. No dispatch reads the image that it writes:
// levels 1, levels 2, 3, 6 and 7, and levels 4 and 5 have one each. Upsampling writes over level 1.
#pragma once

#include <array>

#include "images.h"

namespace pellucid {

constexpr uint32_t kFirstLevel = 1, kPyramidImages = 3;

struct PyramidPlace {
  int32_t x, y;  // in the level's image
  struct {
    int32_t x, y, width, height;
  } rect;  // texels of the level that the render rect needs, as levelRect of compute/diffusion/texel.glsl
};

struct Pyramid {
  Pyramid() = default;
  Pyramid(glm::uvec2 extent, const Rect& rect);

  // The coarsest level in use: odd, because a dispatch that downsamples makes two levels, and no coarser than
  // it takes for the image to lie on 2 x 2 texels.
  uint32_t coarsest = 0;

  // By level, from kFirstLevel on; coarser levels than those in use have places, too.
  std::array<PyramidPlace, PELLUCID_LAST_LEVEL + 1> levels{};

  // The column where the shares of level 2 begin after upsampling, in the image of level 1.
  int32_t sharesColumn = 0;

  // Extents of the images, for any render rect.
  struct Extent {
    uint32_t width, height;
  };
  std::array<Extent, kPyramidImages> images{};
};

}  // namespace pellucid
