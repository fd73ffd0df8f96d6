// Models of fewer triangles.
#pragma once

#include "raster/model.h"

namespace pellucid::harness {

// The model with about `ratio` of each part's triangles, (0, 1], by meshoptimizer's edge collapse (quadric
// errors). Vertices, parts and surfaces stay, and a part keeps the triangles that cannot be taken away
// without changing its topology. Throws InputError for another ratio.
Model simplified(const Model& model, double ratio);

}  // namespace pellucid::harness
