#include "gltf/node.h"

#include <optional>

#include "gltf/accessor.h"

namespace pellucid::harness {

namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

}  // namespace

std::vector<PlacedNode> placeNodes(const GltfDocument& document, const Pose& pose) {
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) document.fail("scenes", "the file has none: there is nothing to draw");
  const std::size_t scene =
      model.defaultScene < 0 ? 0 : document.index(model.defaultScene, model.scenes.size(), "scene", "scenes");
  struct Pending {
    std::size_t node;
    glm::dmat4 worldFromParent;
  };
  std::vector<Pending> pending;
  std::vector<PlacedNode> placed;
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
    const glm::dmat4 world = next.worldFromParent * parentFromNode(document, pose, next.node);
    placed.push_back({next.node, world});
    push(model.nodes[next.node].children, world, "nodes[" + std::to_string(next.node) + "].children");
  }
  return placed;
}

std::vector<glm::dmat4> readInstances(const GltfDocument& document, std::size_t node) {
  const GltfJson* extension = extensionOf(document.json["nodes"][node], kInstancing);
  if (!extension) return {glm::dmat4(1)};
  const std::string field = "nodes[" + std::to_string(node) + "].extensions." + kInstancing + ".attributes";
  const auto attributes = extension->find("attributes");
  if (attributes == extension->end() || !attributes->is_object()) document.fail(field, "is missing");
  std::optional<std::size_t> count;
  const auto read = [&](const char* name, int components) -> std::optional<AccessorValues> {
    if (!attributes->contains(name)) return std::nullopt;
    const std::string where = field + "." + name;
    AccessorValues values =
        readFloats(document, document.reference(*attributes, name, field), components, components, where);
    if (count && *count != values.count())
      document.fail(where, std::to_string(values.count()) + " are not the " + std::to_string(*count) +
                               " of the other attributes");
    count = values.count();
    return values;
  };
  const auto translation = read("TRANSLATION", 3), rotation = read("ROTATION", 4), scale = read("SCALE", 3);
  if (!count) document.fail(field, "has none of TRANSLATION, ROTATION and SCALE");
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < *count; ++i) {
    Parts parts;
    if (translation) parts.translation.assign((*translation)[i], (*translation)[i] + 3);
    if (rotation) parts.rotation.assign((*rotation)[i], (*rotation)[i] + 4);
    if (scale) parts.scale.assign((*scale)[i], (*scale)[i] + 3);
    result.push_back(matrixOf(document, parts, field + ".ROTATION[" + std::to_string(i) + "]"));
  }
  return result;
}

}  // namespace pellucid::harness
