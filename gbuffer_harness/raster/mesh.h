// Meshes that are made: of distance fields, and with fewer triangles.
#pragma once

#include "raster/model.h"
#include "scene/model.h"

namespace pellucid::harness {

// The objects of a scene of distance fields, and its materials: surface nets (Gibson 1998) whose vertices are
// then moved onto the surface. cell: mm between vertices, > 0. Throws InputError for other solids.
Model meshOf(const SceneModel& scene, const std::string& name, double cell);

// The model with about `ratio` of each part's triangles, (0, 1], by meshoptimizer's edge collapse (quadric
// errors). Vertices, parts and surfaces stay, and a part keeps the triangles that cannot be taken away
// without changing its topology. Throws InputError for another ratio.
Model simplified(const Model& model, double ratio);

}  // namespace pellucid::harness
