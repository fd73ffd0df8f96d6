// Bodies that a point lies inside of.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// Name of the first surface with a material of a closed object that the point lies in, not in a hollow of it.
// Open meshes enclose nothing. Objects of surfaces without a material are not looked at. point: world.
std::optional<std::string> enclosingBody(const Model& model, const std::array<double, 3>& point);

// A sentence, which begins with the model's name, for each opaque surface that begins inside a closed
// translucent object: a gather's paths are straight, and small surfaces also block paths that bend.
std::vector<std::string> opaqueInside(const Model& model);

// Throws InputError naming the model and the light: a point or spot light inside a translucent body, whose
// light enters through no face that a shadow map could hold.
void refuseEnclosedLights(const Model& model);

}  // namespace pellucid::harness
