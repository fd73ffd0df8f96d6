// Places of a glTF file's nodes.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "gltf/document.h"

namespace pellucid::harness {

// The node as it stands in the file. Throws InputError for a transform that is not made of finite numbers.
glm::dmat4 parentFromNode(const Field& node);

// The matrices that take vertices of a mesh, as its joints bind them, to the world. skin: the field that holds the
// skin's index. worldFromNode: by node. Throws InputError naming the skin or `skin`.
std::vector<glm::dmat4> readJoints(const GltfDocument& document, const Field& skin,
                                   const std::vector<std::optional<glm::dmat4>>& worldFromNode);

}  // namespace pellucid::harness
