// Places of a glTF file's nodes.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace pellucid::harness {

// The node as it stands in the file. Throws InputError for a transform that is not made of finite numbers.
glm::dmat4 parentFromNode(const GltfDocument& document, std::size_t node);

// The matrices that take vertices of a mesh, as its joints bind them, to the world. worldFromNode: by node.
// Throws InputError naming the skin, or `field`, what refers to it.
std::vector<glm::dmat4> readJoints(const GltfDocument& document, int skin,
                                   const std::vector<std::optional<glm::dmat4>>& worldFromNode,
                                   const std::string& field);

}  // namespace pellucid::harness
