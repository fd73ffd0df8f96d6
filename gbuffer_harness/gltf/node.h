// The node hierarchy of a glTF scene.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>

#include "gltf/document.h"

namespace pellucid::harness {

// Calls visit(node index, worldFromNode) for every node of the default scene. Throws InputError when a
// transform is not made of finite numbers, and when a node is reached twice, as in a cycle.
void forEachNode(const GltfDocument& document,
                 const std::function<void(std::size_t, const glm::dmat4&)>& visit);

}  // namespace pellucid::harness
