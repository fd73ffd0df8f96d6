// Triangles of glTF meshes in world space.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "gltf/attributes.h"
#include "gltf/document.h"
#include "raster/model.h"

namespace pellucid::harness {

// How a mesh stands in the world.
struct MeshPose {
  glm::dmat4 worldFromMesh{1};
  std::vector<glm::dmat4> joints;  // of its skin, in place of worldFromMesh; empty: it has none
  std::vector<double> weights;     // of morph targets
};

// Appends a primitive to the model's vertices and indices; returns whether there was a triangle in it. The
// vertices' positions go to `positions`, in world space and in double precision, and stay 0 in the model.
// Without normals every triangle gets its own.
// Throws InputError naming `field`, the primitive, or the accessor.
bool appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const std::string& field, const MeshPose& pose, const TexCoords& texCoords, Model& model,
                     std::vector<glm::dvec3>& positions, std::vector<std::string>& warnings);

}  // namespace pellucid::harness
