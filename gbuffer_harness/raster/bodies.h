// Bodies of one medium that do not touch each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

struct BodySeparation {
  std::size_t bodies = 0;  // that have a medium
  std::size_t added = 0;   // numbers
};

// Gives bodies of one medium numbers of their own where light of one would reach the other: the diffusion and
// the gather take light from pixels and texels of their own number alone. Bodies out of each other's reach
// share a number. A body is all that hangs together: parts that share corners, touch, cut each other or lie
// in each other, whatever their objects are. Model::bodies gets the numbers; `reach` (mm, one each): of the
// light of Model::materials, 0 of thin walls.
BodySeparation separateBodies(Model& model, const std::vector<double>& reach);

// Takes the numbers back.
void joinBodies(Model& model);

// Materials of all numbers: Model::materials, and one for each of Model::bodies.
std::vector<MaterialSource> withBodies(std::vector<MaterialSource> materials,
                                       const std::vector<std::uint8_t>& bodies);

}  // namespace pellucid::harness
