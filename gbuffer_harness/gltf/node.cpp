#include "gltf/node.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace pellucid::harness {

namespace {

// `values` when they are `count` finite numbers, `absent` when there are none.
std::vector<double> numbers(const GltfDocument& document, const std::vector<double>& values,
                            std::vector<double> absent, const std::string& field) {
  if (values.empty()) return absent;
  if (values.size() != absent.size() ||
      !std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) < 1e30; }))
    document.fail(field, "is not " + std::to_string(absent.size()) + " numbers below 1e30");
  return values;
}

glm::dmat4 transformOf(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  const std::string field = "nodes[" + std::to_string(index) + "].";
  if (!node.matrix.empty()) {
    const auto m = numbers(document, node.matrix, std::vector<double>(16), field + "matrix");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
    if (glm::transpose(matrix)[3] != glm::dvec4(0, 0, 0, 1))
      document.fail(field + "matrix", "its last row is not 0, 0, 0, 1");
    return matrix;
  }
  const auto t = numbers(document, node.translation, {0, 0, 0}, field + "translation");
  const auto r = numbers(document, node.rotation, {0, 0, 0, 1}, field + "rotation");
  const auto s = numbers(document, node.scale, {1, 1, 1}, field + "scale");
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  if (!(glm::length(rotation) > 0)) document.fail(field + "rotation", "is a quaternion of length 0");
  return glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(glm::normalize(rotation)) *
         glm::scale(glm::dmat4(1), {s[0], s[1], s[2]});
}

}  // namespace

void forEachNode(const GltfDocument& document,
                 const std::function<void(std::size_t, const glm::dmat4&)>& visit) {
  const tinygltf::Model& model = document.model;
  const std::size_t scene = document.index(model.defaultScene >= 0 ? model.defaultScene : 0,
                                           model.scenes.size(), "scene", "scenes");
  struct Pending {
    std::size_t node;
    glm::dmat4 worldFromParent;
  };
  std::vector<Pending> pending;
  std::vector<bool> reached(model.nodes.size(), false);
  const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& world, const std::string& field) {
    // Backwards, so that the stack gives them in the file's order.
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
      const std::size_t node = document.index(*i, model.nodes.size(), field, "nodes");
      if (reached[node])
        document.fail(field, "nodes[" + std::to_string(*i) + "] is reached twice; nodes have to form a tree");
      reached[node] = true;
      pending.push_back({node, world});
    }
  };
  push(model.scenes[scene].nodes, glm::dmat4(1), "scenes[" + std::to_string(scene) + "].nodes");
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const glm::dmat4 world = next.worldFromParent * transformOf(document, next.node);
    visit(next.node, world);
    push(model.nodes[next.node].children, world, "nodes[" + std::to_string(next.node) + "].children");
  }
}

}  // namespace pellucid::harness
