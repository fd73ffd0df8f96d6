#include "gltf/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf/accessor.h"

namespace pellucid::harness {

namespace {

std::string nodeName(std::size_t node) { return "nodes[" + std::to_string(node) + "]"; }

// `values` when they are `count` finite numbers, `absent` when there are none.
std::vector<double> numbers(const GltfDocument& document, const std::vector<double>& values,
                            std::vector<double> absent, const std::string& field) {
  if (values.empty()) return absent;
  if (values.size() != absent.size() ||
      !std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) < 1e30; }))
    document.fail(field, "is not " + std::to_string(absent.size()) + " numbers below 1e30");
  return values;
}

const GltfJson& array(const GltfDocument& document, const GltfJson& object, const char* key,
                      const std::string& field) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array())
    document.fail(field + "." + key, "is missing or not an array");
  return *found;
}

}  // namespace

glm::dmat4 parentFromNode(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  const std::string field = nodeName(index) + ".";
  if (node.matrix.empty()) {
    const auto t = numbers(document, node.translation, {0, 0, 0}, field + "translation"),
               r = numbers(document, node.rotation, {0, 0, 0, 1}, field + "rotation"),
               s = numbers(document, node.scale, {1, 1, 1}, field + "scale");
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    if (!(glm::length(rotation) > 0)) document.fail(field + "rotation", "is a quaternion of length 0");
    return glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(glm::normalize(rotation)) *
           glm::scale(glm::dmat4(1), {s[0], s[1], s[2]});
  }
  const auto m = numbers(document, node.matrix, std::vector<double>(16), field + "matrix");
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
  // Exporters multiply matrices in floats.
  constexpr double kRounding = 1e-5;
  glm::dvec4 last = glm::transpose(matrix)[3];
  if (last.w != 0) last /= last.w;
  if (!(glm::length(last - glm::dvec4(0, 0, 0, 1)) <= kRounding))
    document.fail(field + "matrix", "its last row, numbers 4, 8, 12 and 16, is not 0, 0, 0, 1; matrices are column-major");
  matrix /= matrix[3][3];
  for (int i = 0; i < 4; ++i) matrix[i][3] = i == 3;
  return matrix;
}

std::vector<glm::dmat4> readJoints(const GltfDocument& document, int skin,
                                   const std::vector<std::optional<glm::dmat4>>& worldFromNode,
                                   const std::string& field) {
  const auto skins = document.json.find("skins");
  const std::size_t index =
      document.index(skin, skins == document.json.end() ? 0 : skins->size(), field, "skins");
  const GltfJson& source = (*skins)[index];
  const std::string name = "skins[" + std::to_string(index) + "]";
  const GltfJson& joints = array(document, source, "joints", name);
  std::optional<AccessorValues> inverse;
  if (source.contains("inverseBindMatrices")) {
    inverse = readFloats(document, document.reference(source, "inverseBindMatrices", name), 16, 16,
                         name + ".inverseBindMatrices");
    if (inverse->count() < joints.size())
      document.fail(name + ".inverseBindMatrices", "are " + std::to_string(inverse->count()) + " for " +
                                                       std::to_string(joints.size()) + " joints");
  }
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string joint = name + ".joints[" + std::to_string(i) + "]";
    if (!joints[i].is_number_unsigned() || joints[i].get<std::uint64_t>() >= worldFromNode.size())
      document.fail(
          joint, joints[i].dump() + " is not one of the " + std::to_string(worldFromNode.size()) + " nodes");
    const std::optional<glm::dmat4>& world = worldFromNode[joints[i].get<std::size_t>()];
    if (!world) document.fail(joint, nodeName(joints[i].get<std::size_t>()) + " is not in the scene");
    glm::dmat4 bind(1);
    for (int k = 0; inverse && k < 16; ++k) bind[k / 4][k % 4] = static_cast<double>((*inverse)[i][k]);
    result.push_back(*world * bind);
  }
  return result;
}

}  // namespace pellucid::harness
