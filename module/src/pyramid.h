// Where the levels of the diffusion pyramid lie in its image. Level 1 is at the left, the coarser ones are
// below each other beside it.
#pragma once

#include "frame.h"

namespace pellucid {

constexpr uint32_t kFirstLevel = 1;

// The coarsest level in use: odd, because a reduction makes two levels, and no coarser than it takes for the
// image to lie on 2 x 2 texels.
uint32_t coarsestLevel(const PellucidFrame& frame);

// Whether level 1 is still read when level 2 has been resolved: at the quality that sums edges by their
// distances, which a target error may choose.
bool keepsFirstLevel(const PellucidFrame& frame);

struct PyramidPlace {
  int32_t x, y;  // in the image
  struct {
    int32_t x, y, width, height;
  } rect;  // texels of the level that the render rect needs, as levelRect of compute/lib/pyramid.glsl
};

PyramidPlace placeOf(const PellucidFrame& frame, uint32_t level);

// Where the resolved level 2 and its shares begin: beside each other where level 1 was or, where edges still
// read that, below each other beside the coarser levels.
struct ResolvedPlace {
  int32_t x, y, sharesX, sharesY;
};

ResolvedPlace resolvedPlaceOf(const PellucidFrame& frame);

// Where the clusters of a level begin: beside the level, which as all coarser ones is at most half as wide as
// level 2.
int32_t clusterColumn(const PellucidFrame& frame, uint32_t level);

struct PyramidTexel {
  int32_t x, y;
};

// Where the second ones of two begin, of levels 3 and coarser: below the level, right of what the next one
// has.
PyramidTexel secondPlace(const PellucidFrame& frame, uint32_t level);

// Where edges are summed, of the texel that says whether any is: right of level 1, whose rows have two more
// texels than it needs.
PyramidTexel summedPlace(const PellucidFrame& frame);

// Of the pyramid's image, for any render rect.
struct PyramidExtent {
  uint32_t width, height;
};

PyramidExtent pyramidExtent(const PellucidFrame& frame);

}  // namespace pellucid
