// Triangles of procedural scenes.
#pragma once

#include "raster/model.h"
#include "scene/model.h"

namespace pellucid::harness {

// The objects of a scene of distance fields, and its materials: surface nets (Gibson 1998) whose vertices are
// then moved onto the surface. cell: mm between vertices, > 0. Throws InputError for other solids.
Model meshOf(const SceneModel& scene, const std::string& name, double cell);

}  // namespace pellucid::harness
