// Vertex attributes of glTF primitives, with texture coordinates transformed and morph targets added.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf/accessor.h"
#include "gltf/document.h"

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

struct Attributes {
  AccessorValues position;
  std::optional<AccessorValues> normal, uv, color, mark, normalUv, lobeUv, tangent;
  // Joints and their weights, four for each set: JOINTS_0, JOINTS_1 and so on, as many as WEIGHTS_n.
  std::vector<AccessorValues> joints, weights;

  std::size_t count() const { return position.count(); }
};

// weights: of the morph targets; those that are missing are 0. Throws InputError naming the attribute or
// accessor, and `field`, the primitive, for counts that differ.
Attributes readAttributes(const GltfDocument& document, const tinygltf::Primitive& primitive,
                          const std::string& field, const TexCoords& texCoords,
                          const std::vector<double>& weights);

// Reads the set and the transform of a texture info in the file's JSON (baseColorTexture and its like).
TexCoord readTexCoord(const GltfDocument& document, const GltfJson& textureInfo, const std::string& field);

}  // namespace pellucid::harness
