// Triangles of glTF meshes in world space: vertex attributes, with texture coordinates transformed and morph
// targets added.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "raster/model.h"

namespace pellucid::harness {

// Source of a texture's coordinates.
struct TexCoord {
  int set = -1;             // the n of TEXCOORD_n; -1: there is no texture
  glm::dmat3 transform{1};  // KHR_texture_transform; of (u, v, 1)
  bool operator==(const TexCoord&) const = default;
};

// Those of a surface's textures.
struct TexCoords {
  TexCoord color, normal, lobe;
};

// Reads the set and the transform of a texture info in the file's JSON (baseColorTexture and its like).
TexCoord readTexCoord(const GltfDocument& document, const GltfJson& textureInfo, const std::string& field);

// The most vertices of a scene, whose meshes several nodes may share.
constexpr std::size_t kMaxVertices = 1u << 24;

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
