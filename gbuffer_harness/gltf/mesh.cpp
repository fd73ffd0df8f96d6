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

struct Attributes {
  AccessorValues position;
  std::optional<AccessorValues> normal, uv, color, mark, normalUv, lobeUv, tangent;
  // Joints and their weights, four for each set: JOINTS_0, JOINTS_1 and so on, as many as WEIGHTS_n.
  std::vector<AccessorValues> joints, weights;

  std::size_t count() const { return position.count(); }
};

constexpr const char* kTransform = "KHR_texture_transform";

void requireCount(const GltfDocument& document, const AccessorValues& values, const Attributes& attributes,
                  const std::string& field) {
  if (values.count() != attributes.count())
    document.fail(field, "have " + std::to_string(attributes.count()) + " and " +
                             std::to_string(values.count()) + " elements");
}

// Adds weight * the target's displacements.
void morph(const GltfDocument& document, const std::map<std::string, int>& target, double weight,
           const std::string& field, Attributes& attributes) {
  const auto add = [&](const char* name, AccessorValues& to) {
    const auto found = target.find(name);
    if (found == target.end()) return;
    // A tangent's displacement has no w.
    const AccessorValues by = readFloats(document, found->second, 3, 3, field + "." + name);
    requireCount(document, by, attributes, field + "." + name);
    for (std::size_t i = 0; i < by.count(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        float& value = to.data[i * static_cast<std::size_t>(to.components) + c];
        value = static_cast<float>(value + weight * static_cast<double>(by[i][c]));
      }
  };
  add("POSITION", attributes.position);
  if (attributes.normal) add("NORMAL", *attributes.normal);
  if (attributes.tangent) add("TANGENT", *attributes.tangent);
}

void transform(const glm::dmat3& matrix, AccessorValues& uv) {
  if (matrix == glm::dmat3(1)) return;
  for (std::size_t i = 0; i < uv.data.size(); i += 2) {
    const glm::dvec3 result = matrix * glm::dvec3(uv.data[i], uv.data[i + 1], 1);
    uv.data[i] = static_cast<float>(result.x);
    uv.data[i + 1] = static_cast<float>(result.y);
  }
}

// weights: of the morph targets; those that are missing are 0. Throws InputError naming the attribute or
// accessor, and `field`, the primitive, for counts that differ.
Attributes readAttributes(const GltfDocument& document, const tinygltf::Primitive& primitive,
                          const std::string& field, const TexCoords& texCoords,
                          const std::vector<double>& weights) {
  const std::string where = field + ".attributes.";
  const auto find = [&](const std::string& name, int least, int most) -> std::optional<AccessorValues> {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    return readFloats(document, found->second, least, most, where + name);
  };
  std::optional<AccessorValues> position = find("POSITION", 3, 3);
  if (!position) document.fail(where + "POSITION", "is missing");
  Attributes attributes;
  attributes.position = std::move(*position);
  attributes.normal = find("NORMAL", 3, 3);
  attributes.color = find("COLOR_0", 3, 4);
  attributes.mark = find("_TRANSLUCENT", 1, 1);
  const auto findUv = [&](const TexCoord& use) -> std::optional<AccessorValues> {
    if (use.set < 0) return std::nullopt;
    auto uv = find("TEXCOORD_" + std::to_string(use.set), 2, 2);
    if (uv) transform(use.transform, *uv);
    return uv;
  };
  attributes.uv = findUv(texCoords.color);
  attributes.normalUv = findUv(texCoords.normal);
  attributes.lobeUv = findUv(texCoords.lobe);
  if (texCoords.normal.set >= 0) attributes.tangent = find("TANGENT", 4, 4);
  for (int set = 0;; ++set) {
    auto joints = find("JOINTS_" + std::to_string(set), 4, 4);
    auto shares = find("WEIGHTS_" + std::to_string(set), 4, 4);
    if (!joints || !shares) break;
    attributes.joints.push_back(std::move(*joints));
    attributes.weights.push_back(std::move(*shares));
  }
  for (const auto* other : {&attributes.normal, &attributes.uv, &attributes.color, &attributes.mark,
                            &attributes.normalUv, &attributes.lobeUv, &attributes.tangent})
    if (*other) requireCount(document, **other, attributes, field + ".attributes");
  for (const auto* sets : {&attributes.joints, &attributes.weights})
    for (const AccessorValues& set : *sets) requireCount(document, set, attributes, field + ".attributes");
  for (std::size_t i = 0; i < primitive.targets.size() && i < weights.size(); ++i)
    if (weights[i] != 0)
      morph(document, primitive.targets[i], weights[i], field + ".targets[" + std::to_string(i) + "]",
            attributes);
  return attributes;
}

constexpr std::size_t kMaxIndices = 3 * kMaxVertices;

// Far beyond any scene, and its square still is a float.
constexpr double kLargestCoordinate = 1e18;

// A primitive's vertices before the world's origin is chosen: those of `vertices` have positions of 0.
struct WorldVertices {
  std::vector<Vertex> vertices;
  std::vector<glm::dvec3> positions;
};

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
glm::dvec3 areaNormal(const std::vector<glm::dvec3>& positions, const std::uint32_t* corners) {
  const glm::dvec3& a = positions[corners[0]];
  return glm::cross(positions[corners[1]] - a, positions[corners[2]] - a);
}

std::array<float, 3> unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? toArray(glm::vec3(v / length)) : std::array<float, 3>{0, 0, 0};
}

// Each triangle its own vertices, with its own normal.
void makeFlat(WorldVertices& world, std::vector<std::uint32_t>& indices) {
  WorldVertices flat;
  flat.vertices.reserve(indices.size());
  flat.positions.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const auto normal = unit(areaNormal(world.positions, &indices[i]));
    for (std::size_t k = i; k < i + 3; ++k) {
      flat.positions.push_back(world.positions[indices[k]]);
      flat.vertices.push_back(world.vertices[indices[k]]);
      flat.vertices.back().normal = normal;
      flat.vertices.back().tangent = {0, 0, 0, 0};  // glTF 2.0, 3.7.2.1: not to be used without normals
    }
  }
  world = std::move(flat);
  std::iota(indices.begin(), indices.end(), 0u);
}

// Normals of length 0 are replaced by the mean of the triangles around.
void repairNormals(WorldVertices& world, const std::vector<std::uint32_t>& indices) {
  constexpr std::array<float, 3> kNone = {0, 0, 0};
  std::vector<std::uint32_t> broken;
  for (std::uint32_t i = 0; i < world.vertices.size(); ++i)
    if (world.vertices[i].normal == kNone) broken.push_back(i);
  if (broken.empty()) return;
  std::vector<glm::dvec3> mean(world.vertices.size(), glm::dvec3(0));
  for (std::size_t i = 0; i < indices.size(); i += 3)
    for (std::size_t k = i; k < i + 3; ++k) mean[indices[k]] += areaNormal(world.positions, &indices[i]);
  for (const std::uint32_t i : broken) world.vertices[i].normal = unit(mean[i]);
}

// Whether most of the area has vertex normals that point to the other side than the winding does.
bool opposesWinding(const WorldVertices& world, const std::vector<std::uint32_t>& indices) {
  double all = 0, opposed = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 area = areaNormal(world.positions, &indices[i]);
    glm::dvec3 sum(0);
    for (std::size_t k = i; k < i + 3; ++k) sum += glm::dvec3(toVec3(world.vertices[indices[k]].normal.data()));
    all += glm::length(area);
    if (glm::dot(area, sum) < 0) opposed += glm::length(area);
  }
  return opposed > 0.5 * all;
}

// The mean of the joints' matrices by the vertex's weights.
glm::dmat4 skinned(const GltfDocument& document, const Attributes& attributes, std::size_t vertex,
                   const std::vector<glm::dmat4>& joints, const std::string& field) {
  glm::dmat4 sum(0);
  double total = 0;
  for (std::size_t set = 0; set < attributes.joints.size(); ++set)
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = static_cast<double>(attributes.weights[set][vertex][k]);
      if (!(weight > 0)) continue;
      const auto joint = static_cast<std::size_t>(std::max(attributes.joints[set][vertex][k], 0.0f));
      if (joint >= joints.size())
        document.fail(field + ".attributes.JOINTS_" + std::to_string(set),
                      std::to_string(joint) + " of vertex " + std::to_string(vertex) + " is not one of the " +
                          std::to_string(joints.size()) + " joints");
      sum += weight * joints[joint];
      total += weight;
    }
  if (!(total > 0))
    document.fail(field + ".attributes.WEIGHTS_0", "are all 0 at vertex " + std::to_string(vertex));
  return sum / total;
}

// Transform of normals: up to a factor the inverse transpose, and finite where the matrix is singular.
struct NormalTransform {
  glm::dmat3 linear, cofactors;
  double sign;

  explicit NormalTransform(const glm::dmat4& matrix)
      : linear(matrix),
        cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                  glm::cross(linear[0], linear[1])),
        sign(glm::determinant(linear) < 0 ? -1 : 1) {}
};

WorldVertices toWorld(const GltfDocument& document, const Attributes& attributes, const std::string& field,
                      const MeshPose& pose) {
  NormalTransform normals(pose.worldFromMesh);
  glm::dmat4 worldFromMesh = pose.worldFromMesh;
  WorldVertices world;
  world.vertices.resize(attributes.count());
  world.positions.resize(attributes.count());
  for (std::size_t i = 0; i < attributes.count(); ++i) {
    if (!pose.joints.empty()) {
      worldFromMesh = skinned(document, attributes, i, pose.joints, field);
      normals = NormalTransform(worldFromMesh);
    }
    Vertex& v = world.vertices[i];
    const glm::dvec3 position = worldFromMesh * glm::dvec4(toVec3(attributes.position[i]), 1);
    if (!glm::all(glm::lessThan(glm::abs(position), glm::dvec3(kLargestCoordinate))))
      document.fail(field + ".attributes.POSITION",
                    "vertex " + std::to_string(i) + " is farther than 1e18 from the origin");
    world.positions[i] = position;
    v.normal = {0, 0, 0};
    if (attributes.normal)
      v.normal = unit(normals.sign * (normals.cofactors * glm::dvec3(toVec3((*attributes.normal)[i]))));
    if (attributes.uv) std::copy_n((*attributes.uv)[i], 2, v.uv.begin());
    if (attributes.normalUv) std::copy_n((*attributes.normalUv)[i], 2, v.normalUv.begin());
    if (attributes.lobeUv) std::copy_n((*attributes.lobeUv)[i], 2, v.lobeUv.begin());
    if (attributes.tangent) {
      const float* tangent = (*attributes.tangent)[i];
      const std::array<float, 3> along = unit(normals.linear * glm::dvec3(toVec3(tangent)));
      v.tangent = {along[0], along[1], along[2], static_cast<float>(normals.sign) * tangent[3]};
    }
    if (attributes.color) {
      const float* const color = (*attributes.color)[i];
      std::copy_n(color, 3, v.color.begin());
      if (attributes.color->components == 4) v.alpha = color[3];
    }
    if (attributes.mark) v.mark = *(*attributes.mark)[i];
  }
  return world;
}

// True if the mesh's transform turns the outside in.
bool isMirrored(const GltfDocument& document, const Attributes& attributes, const std::string& field,
                const MeshPose& pose) {
  const glm::dmat4 matrix =
      pose.joints.empty() ? pose.worldFromMesh : skinned(document, attributes, 0, pose.joints, field);
  return glm::determinant(glm::dmat3(matrix)) < 0;
}

}  // namespace

TexCoord readTexCoord(const GltfDocument& document, const GltfJson& textureInfo, const std::string& field) {
  TexCoord result;
  const auto readSet = [&](const GltfJson& object, const std::string& where) {
    const auto found = object.find("texCoord");
    if (found == object.end()) return;
    constexpr unsigned kMostSets = 1000;
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() >= kMostSets)
      document.fail(where + ".texCoord", found->dump() + " is not the number of a set");
    result.set = *found;
  };
  result.set = 0;
  readSet(textureInfo, field);
  const GltfJson* extension = extensionOf(textureInfo, kTransform);
  if (!extension) return result;
  const std::string where = field + ".extensions." + kTransform;
  readSet(*extension, where);
  const auto number = [&](const GltfJson& value, const std::string& key) {
    if (!value.is_number() || !(std::abs(value.get<double>()) < 1e9))
      document.fail(where + "." + key, value.dump() + " is not a number below 1e9");
    return value.get<double>();
  };
  const auto pair = [&](const char* key, glm::dvec2 absent) {
    const auto found = extension->find(key);
    if (found == extension->end()) return absent;
    if (!found->is_array() || found->size() != 2)
      document.fail(where + "." + key, found->dump() + " is not 2 numbers");
    return glm::dvec2(number((*found)[0], key), number((*found)[1], key));
  };
  const glm::dvec2 offset = pair("offset", {0, 0}), scale = pair("scale", {1, 1});
  const auto rotation = extension->find("rotation");
  const double angle = rotation == extension->end() ? 0 : number(*rotation, "rotation");
  const double c = std::cos(angle), s = std::sin(angle);
  // v grows downwards, so that counterclockwise takes +u to -v.
  result.transform = glm::dmat3(1, 0, 0, 0, 1, 0, offset.x, offset.y, 1) *
                     glm::dmat3(c, -s, 0, s, c, 0, 0, 0, 1) *
                     glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, 1);
  return result;
}

bool appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const std::string& field, const MeshPose& pose, const TexCoords& texCoords, Model& model,
                     std::vector<glm::dvec3>& positions, std::vector<std::string>& warnings) {
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      document.fail(field + ".mode", std::to_string(primitive.mode) + " is not a mode of glTF");
    warnings.push_back(field + ": points and lines are not drawn");
    return false;
  }
  const Attributes attributes = readAttributes(document, primitive, field, texCoords, pose.weights);
  const auto warnOfLacking = [&](const TexCoord& use, bool has, const char* what) {
    if (use.set >= 0 && !has)
      warnings.push_back(field + ": has no TEXCOORD_" + std::to_string(use.set) + " for its " + what);
  };
  warnOfLacking(texCoords.normal, attributes.normalUv.has_value(), "normal map, which is ignored");
  warnOfLacking(texCoords.color, attributes.uv.has_value(), "color texture, whose first texel is taken everywhere");
  warnOfLacking(texCoords.lobe, attributes.lobeUv.has_value(),
                "textures of transmission and scattering, whose first texels are taken everywhere");
  const auto isFraction = [](float v) { return v >= 0 && v <= 1; };
  if (attributes.color && !std::all_of(attributes.color->data.begin(), attributes.color->data.end(), isFraction))
    document.fail(field + ".attributes.COLOR_0", "has values outside 0 .. 1; integers need \"normalized\": true");
  std::vector<std::uint32_t> indices;
  if (primitive.indices != -1) {
    indices = readIndices(document, primitive.indices, attributes.count(), field + ".indices");
  } else {
    indices.resize(attributes.count());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  indices = toTriangles(document, primitive.mode, field, std::move(indices));

  // Mirrored by its transform, a triangle's outside would become its inside.
  if (isMirrored(document, attributes, field, pose))
    for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
  WorldVertices world = toWorld(document, attributes, field, pose);
  if (attributes.normal)
    repairNormals(world, indices);
  else
    makeFlat(world, indices);
  if (attributes.normal && opposesWinding(world, indices))
    warnings.push_back(field + ".attributes.NORMAL: points against the winding of most triangles, whose seen faces then have no light; "
                               "recalculate the normals, or flip the triangles");

  if (model.vertices.size() + world.vertices.size() > kMaxVertices ||
      model.indices.size() + indices.size() > kMaxIndices)
    document.fail(field, "with it the scene has more than 2^24 vertices or triangles");
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  model.vertices.insert(model.vertices.end(), world.vertices.begin(), world.vertices.end());
  positions.insert(positions.end(), world.positions.begin(), world.positions.end());
  for (const std::uint32_t i : indices) model.indices.push_back(first + i);
  return !indices.empty();
}

}  // namespace pellucid::harness
