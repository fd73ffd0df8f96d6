#include "gltf/pose.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf/accessor.h"

namespace pellucid::harness {

namespace {

constexpr double kMost = 1e30;

template <std::size_t N>
std::array<double, N> numbersOr(const Field& node, const char* key, const std::array<double, N>& absent) {
  const auto found = node.find(key);
  return found ? found->numbers<N>(-kMost, kMost) : absent;
}

}  // namespace

glm::dmat4 parentFromNode(const Field& node) {
  if (const auto field = node.find("matrix")) {
    const auto m = field->numbers<16>(-kMost, kMost);
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
    if (glm::transpose(matrix)[3] != glm::dvec4(0, 0, 0, 1)) field->fail("its last row is not 0, 0, 0, 1");
    return matrix;
  }
  const auto t = numbersOr<3>(node, "translation", {0, 0, 0}), s = numbersOr<3>(node, "scale", {1, 1, 1});
  const auto r = numbersOr<4>(node, "rotation", {0, 0, 0, 1});
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  if (!(glm::length(rotation) > 0)) node["rotation"].fail("is a quaternion of length 0");
  return glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(glm::normalize(rotation)) *
         glm::scale(glm::dmat4(1), {s[0], s[1], s[2]});
}

std::vector<glm::dmat4> readJoints(const GltfDocument& document, const Field& skin,
                                   const std::vector<std::optional<glm::dmat4>>& worldFromNode) {
  const Field& source = document.element("skins", skin);
  const std::vector<Field> joints = source["joints"].items();
  std::optional<AccessorValues> inverse;
  if (const auto matrices = source.find("inverseBindMatrices")) {
    inverse = readFloats(document, *matrices, 16, 16);
    if (inverse->count() < joints.size())
      matrices->fail("are " + std::to_string(inverse->count()) + " for " + std::to_string(joints.size()) + " joints");
  }
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::size_t node = document.index("nodes", joints[i]);
    const std::optional<glm::dmat4>& world = worldFromNode[node];
    if (!world) joints[i].fail("nodes[" + std::to_string(node) + "] is not in the scene");
    glm::dmat4 bind(1);
    for (int k = 0; inverse && k < 16; ++k) bind[k / 4][k % 4] = static_cast<double>((*inverse)[i][k]);
    result.push_back(*world * bind);
  }
  return result;
}

}  // namespace pellucid::harness
