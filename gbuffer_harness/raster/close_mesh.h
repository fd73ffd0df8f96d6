// Meshes whose bodies have holes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// An object with a medium whose surface has edges that no second triangle continues, once vertices at one
// place count as one.
struct OpenObject {
  std::uint32_t object = 0;
  std::string surface;         // name of the object's first surface with a material
  std::size_t holes = 0;       // loops of such edges
  std::size_t looseEdges = 0;  // those that lie on no loop: faces turned over, or more than two on an edge
};

// Objects of opaque and thin-walled surfaces are not looked at: light does not walk through them.
std::vector<OpenObject> openObjects(const Model& model);

// Closes each loop with triangles around its center, drawn as the surface next to it. Loose edges stay.
// Returns the number of holes filled.
std::size_t fillHoles(Model& model);

}  // namespace pellucid::harness
