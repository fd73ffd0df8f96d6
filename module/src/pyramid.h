// Where the levels of the diffusion pyramid lie in its image. Level 1 is at the left, the coarser ones are
// below each other beside it.
#pragma once

#include "frame.h"

namespace pellucid {

constexpr uint32_t kFirstLevel = 1;

// The coarsest level in use: odd, because a reduction makes two levels, and no coarser than it takes for the
// image to lie on 2 x 2 texels.
uint32_t coarsestLevel(const PellucidFrame& frame);

struct PyramidPlace {
  int32_t x, y;  // in the image
  struct {
    int32_t x, y, width, height;
  } rect;  // texels of the level that the render rect needs, as levelRect of compute/diffusion/texel.glsl
};

PyramidPlace placeOf(const PellucidFrame& frame, uint32_t level);

// The column where the shares of the resolved level 2 begin. That level lies where level 1 was.
int32_t sharesColumn(const PellucidFrame& frame);

// Of the pyramid's image, for any render rect.
struct PyramidExtent {
  uint32_t width, height;
};

PyramidExtent pyramidExtent(const PellucidFrame& frame);

}  // namespace pellucid
