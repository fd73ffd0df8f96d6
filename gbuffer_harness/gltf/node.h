// The node hierarchy of a glTF scene.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <vector>

#include "gltf/document.h"
#include "gltf/pose.h"

namespace pellucid::harness {

// Calls visit(node index, worldFromNode) for every node of the default scene, as it stands in `pose`. Throws
// InputError when a transform is not made of finite numbers, and when a node is reached twice, as in a cycle.
void forEachNode(const GltfDocument& document, const Pose& pose,
                 const std::function<void(std::size_t, const glm::dmat4&)>& visit);

// nodeFromInstance of each instance of the node's mesh (EXT_mesh_gpu_instancing); without instances the
// identity.
std::vector<glm::dmat4> readInstances(const GltfDocument& document, std::size_t node);

}  // namespace pellucid::harness
