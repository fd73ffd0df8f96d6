#include "gltf/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <optional>

#include "gltf/accessor.h"

namespace pellucid::harness {

namespace {

// Instances multiply a small file's meshes: the bound on what they may become.
constexpr std::size_t kMaxVertices = 1u << 24;
constexpr std::size_t kMaxIndices = 3 * kMaxVertices;

// Far beyond any scene, and its square still is a float.
constexpr double kLargestCoordinate = 1e18;

struct Attributes {
  AccessorValues position;
  std::optional<AccessorValues> normal, uv, color, mark, normalUv, tangent;
};

Attributes readAttributes(const GltfDocument& document, const tinygltf::Primitive& primitive,
                          const std::string& field, const TexCoords& texCoords) {
  const std::string where = field + ".attributes.";
  const auto find = [&](const std::string& name, int least, int most) -> std::optional<AccessorValues> {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    return readFloats(document, found->second, least, most, where + name);
  };
  std::optional<AccessorValues> position = find("POSITION", 3, 3);
  if (!position) document.fail(where + "POSITION", "is missing");
  Attributes attributes{std::move(*position), find("NORMAL", 3, 3), std::nullopt, find("COLOR_0", 3, 4),
                        find("_TRANSLUCENT", 1, 1)};
  const auto findUv = [&](int texCoord) { return find("TEXCOORD_" + std::to_string(texCoord), 2, 2); };
  if (texCoords.color >= 0) attributes.uv = findUv(texCoords.color);
  if (texCoords.normal >= 0) {
    attributes.normalUv = findUv(texCoords.normal);
    attributes.tangent = find("TANGENT", 4, 4);
  }
  for (const auto* other : {&attributes.normal, &attributes.uv, &attributes.color, &attributes.mark,
                            &attributes.normalUv, &attributes.tangent})
    if (*other && (*other)->count() != attributes.position.count())
      document.fail(field + ".attributes", "have " + std::to_string(attributes.position.count()) + " and " +
                                               std::to_string((*other)->count()) + " elements");
  return attributes;
}

// Strips and fans as lists of triangles.
std::vector<std::uint32_t> toTriangles(const GltfDocument& document, int mode, const std::string& field,
                                       std::vector<std::uint32_t> indices) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (indices.size() % 3 != 0)
      document.fail(field, std::to_string(indices.size()) + " indices are not a multiple of 3");
    return indices;
  }
  std::vector<std::uint32_t> list;
  for (std::size_t i = 2; i < indices.size(); ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const bool odd = !fan && i % 2 == 1;  // every second triangle of a strip turns the other way
    const std::uint32_t a = fan ? indices[0] : indices[i - 2], b = indices[i - 1], c = indices[i];
    list.insert(list.end(), {a, odd ? c : b, odd ? b : c});
  }
  return list;
}

glm::vec3 toVec3(const float* v) { return {v[0], v[1], v[2]}; }
std::array<float, 3> toArray(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// Normal of a triangle, as long as twice its area.
glm::vec3 areaNormal(const std::vector<Vertex>& vertices, const std::uint32_t* corners) {
  const glm::vec3 a = toVec3(vertices[corners[0]].position.data());
  return glm::cross(toVec3(vertices[corners[1]].position.data()) - a,
                    toVec3(vertices[corners[2]].position.data()) - a);
}

glm::vec3 unit(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : glm::vec3(0);
}

// Each triangle its own vertices, with its own normal.
void makeFlat(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
  std::vector<Vertex> flat;
  flat.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const auto normal = toArray(unit(areaNormal(vertices, &indices[i])));
    for (std::size_t k = i; k < i + 3; ++k) {
      flat.push_back(vertices[indices[k]]);
      flat.back().normal = normal;
      flat.back().tangent = {0, 0, 0, 0};  // glTF 2.0, 3.7.2.1: not to be used without normals
    }
  }
  vertices = std::move(flat);
  std::iota(indices.begin(), indices.end(), 0u);
}

// Normals of length 0 are replaced by the mean of the triangles around.
void repairNormals(std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
  constexpr std::array<float, 3> kNone = {0, 0, 0};
  std::vector<std::uint32_t> broken;
  for (std::uint32_t i = 0; i < vertices.size(); ++i)
    if (vertices[i].normal == kNone) broken.push_back(i);
  if (broken.empty()) return;
  std::vector<glm::vec3> mean(vertices.size(), glm::vec3(0));
  for (std::size_t i = 0; i < indices.size(); i += 3)
    for (std::size_t k = i; k < i + 3; ++k) mean[indices[k]] += areaNormal(vertices, &indices[i]);
  for (const std::uint32_t i : broken) vertices[i].normal = toArray(unit(mean[i]));
}

std::vector<Vertex> toWorld(const GltfDocument& document, const Attributes& attributes,
                            const std::string& field, const glm::dmat4& worldFromMesh) {
  // Of normals; up to a factor the inverse transpose, and finite where the matrix is singular.
  const glm::dmat3 linear(worldFromMesh);
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const double sign = glm::determinant(linear) < 0 ? -1 : 1;
  std::vector<Vertex> vertices(attributes.position.count());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& v = vertices[i];
    const glm::dvec3 position = worldFromMesh * glm::dvec4(toVec3(attributes.position[i]), 1);
    if (!glm::all(glm::lessThan(glm::abs(position), glm::dvec3(kLargestCoordinate))))
      document.fail(field + ".attributes.POSITION",
                    "vertex " + std::to_string(i) + " is farther than 1e18 from the origin");
    v.position = toArray(glm::vec3(position));
    v.normal = {0, 0, 0};
    if (attributes.normal) {
      const glm::dvec3 n = sign * (cofactors * glm::dvec3(toVec3((*attributes.normal)[i])));
      const double length = glm::length(n);
      if (length > 0) v.normal = toArray(glm::vec3(n / length));
    }
    if (attributes.uv) std::copy_n((*attributes.uv)[i], 2, v.uv.begin());
    if (attributes.normalUv) std::copy_n((*attributes.normalUv)[i], 2, v.normalUv.begin());
    if (attributes.tangent) {
      const float* tangent = (*attributes.tangent)[i];
      const glm::dvec3 t = linear * glm::dvec3(toVec3(tangent));
      const double length = glm::length(t);
      const std::array<float, 3> along = length > 0 ? toArray(glm::vec3(t / length)) : std::array<float, 3>{};
      v.tangent = {along[0], along[1], along[2], static_cast<float>(sign) * tangent[3]};
    }
    if (attributes.color) std::copy_n((*attributes.color)[i], 3, v.color.begin());
    if (attributes.mark) v.mark = *(*attributes.mark)[i];
  }
  return vertices;
}

}  // namespace

bool appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const std::string& field, const glm::dmat4& worldFromMesh, const TexCoords& texCoords,
                     Model& model, std::vector<std::string>& warnings) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      document.fail(field + ".mode", std::to_string(primitive.mode) + " is not a mode of glTF");
    warnings.push_back(field + ": points and lines are not drawn");
    return false;
  }
  const Attributes attributes = readAttributes(document, primitive, field, texCoords);
  if (texCoords.normal >= 0 && !attributes.normalUv)
    warnings.push_back(field + ": has no TEXCOORD_" + std::to_string(texCoords.normal) +
                       " for its normal map, which is ignored");
  std::vector<std::uint32_t> indices;
  if (primitive.indices != -1) {
    indices = readIndices(document, primitive.indices, attributes.position.count(), field + ".indices");
  } else {
    indices.resize(attributes.position.count());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  indices = toTriangles(document, primitive.mode, field, std::move(indices));

  // Mirrored by its transform, a triangle's outside would become its inside.
  if (glm::determinant(glm::dmat3(worldFromMesh)) < 0)
    for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
  std::vector<Vertex> vertices = toWorld(document, attributes, field, worldFromMesh);
  if (attributes.normal)
    repairNormals(vertices, indices);
  else
    makeFlat(vertices, indices);

  if (model.vertices.size() + vertices.size() > kMaxVertices ||
      model.indices.size() + indices.size() > kMaxIndices)
    document.fail(field, "with it the scene has more than 2^24 vertices or triangles");
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  model.vertices.insert(model.vertices.end(), vertices.begin(), vertices.end());
  for (const std::uint32_t i : indices) model.indices.push_back(first + i);
  return !indices.empty();
}

}  // namespace pellucid::harness
