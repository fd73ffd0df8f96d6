#include "gltf/attributes.h"

#include <cmath>

namespace pellucid::harness {

namespace {

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

}  // namespace

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

}  // namespace pellucid::harness
