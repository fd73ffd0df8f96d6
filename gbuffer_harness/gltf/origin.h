// The origin of a model's world, chosen so that floats are fine enough.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// Gives the model's vertices their positions, of which `positions` has the file's. Far from the file's
// origin, they, cameras and lights become relative to model.origin, near the camera named so
// (GltfOptions::camera). Returns whether they did.
bool moveOrigin(Model& model, const std::vector<glm::dvec3>& positions, const std::string& camera);

// A sentence for a person.
std::string originNote(const Model& model);

}  // namespace pellucid::harness
