// Triangles of glTF meshes in world space.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "raster/model.h"

namespace pellucid::harness {

// The n of the TEXCOORD_n that textures use; -1: there is no texture.
struct TexCoords {
  int color = -1, normal = -1;
};

// Appends a primitive to the model's vertices and indices; returns whether there was a triangle in it.
// Without normals every triangle gets its own.
// Throws InputError naming `field`, the primitive, or the accessor.
bool appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const std::string& field, const glm::dmat4& worldFromMesh, const TexCoords& texCoords,
                     Model& model, std::vector<std::string>& warnings);

}  // namespace pellucid::harness
