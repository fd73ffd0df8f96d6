// Triangles of glTF meshes in world space.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "raster/model.h"

namespace pellucid::harness {

// Appends a primitive to the model's vertices and indices; returns whether there was a triangle in it.
// Without normals every triangle gets its own. `texCoord` is the n of the TEXCOORD_n to read, -1: none.
// Throws InputError naming `field`, the primitive, or the accessor.
bool appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const std::string& field, const glm::dmat4& worldFromMesh, int texCoord, Model& model,
                     std::vector<std::string>& warnings);

}  // namespace pellucid::harness
