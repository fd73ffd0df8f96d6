// Bodies of a model: which triangles hang together, whether they close a volume, and what lies inside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
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

// Name of the first surface with a medium of a closed object that the point lies in, not in a hollow of it.
// Open meshes enclose nothing. Objects of opaque and thin-walled surfaces are not looked at. point: world.
std::optional<std::string> enclosingBody(const Model& model, const std::array<double, 3>& point);

// A sentence, which begins with the model's name, for each opaque surface that begins inside a closed
// translucent object: a gather's paths are straight, and small surfaces also block paths that bend.
std::vector<std::string> opaqueInside(const Model& model);

// Throws InputError naming the model and the light: a point or spot light inside a translucent body, whose
// light enters through no face that a shadow map could hold.
void refuseEnclosedLights(const Model& model);

// Removes glowing opaque pieces around or close to a point or spot light, which is the light that they give.
// Returns sentences, which name the light and the surface: of these, and of other opaque pieces around a
// light.
std::vector<std::string> openLamps(Model& model);

}  // namespace pellucid::harness
