// Triangles of a distance field.
#pragma once

#include "raster/model.h"
#include "scene/solid.h"

namespace pellucid::harness {

// Adds vertices and indices of the field's surface inside the cube of that half side around `center`: surface
// nets (Gibson 1998) whose vertices are then moved onto the surface. cell: scene units, > 0.
void addMesh(const DistanceField& field, const Vector3& center, double half, double cell, Model& model);

}  // namespace pellucid::harness
