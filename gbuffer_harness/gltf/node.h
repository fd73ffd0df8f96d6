// The node hierarchy of a glTF scene.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "gltf/document.h"
#include "gltf/pose.h"

namespace pellucid::harness {

struct PlacedNode {
  std::size_t node;
  glm::dmat4 world;  // worldFromNode
};

// Every node of the default scene, as it stands in `pose`, parents before children. Throws InputError when a
// transform is not made of finite numbers, and when a node is reached twice, as in a cycle.
std::vector<PlacedNode> placeNodes(const GltfDocument& document, const Pose& pose);

// nodeFromInstance of each instance of the node's mesh (EXT_mesh_gpu_instancing); without instances the
// identity.
std::vector<glm::dmat4> readInstances(const GltfDocument& document, std::size_t node);

}  // namespace pellucid::harness
