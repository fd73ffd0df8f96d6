// Numbers of accessors, checked against the bytes that there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace pellucid::harness {

// Calls visit with a value of the component type; false: there is no such type.
template <class Visit>
bool withType(int componentType, const Visit& visit) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return visit(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return visit(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return visit(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return visit(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return visit(std::uint32_t());
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return visit(float());
    default:
      return false;
  }
}

struct AccessorValues {
  int components = 0;  // 1..4, or 16 of a matrix, column by column
  std::vector<float> data;

  std::size_t count() const { return data.size() / static_cast<std::size_t>(components); }
  const float* operator[](std::size_t i) const { return &data[i * static_cast<std::size_t>(components)]; }
};

// Every value of the accessor, normalized integers as fractions and other integers (KHR_mesh_quantization)
// as they are. Between `least` and `most` components. Throws InputError naming `field`, what refers to the
// accessor, or the accessor's own field; also for values that are not finite.
AccessorValues readFloats(const GltfDocument& document, int accessor, int least, int most,
                          const std::string& field);

// Vertex indices below `vertexCount`.
std::vector<std::uint32_t> readIndices(const GltfDocument& document, int accessor, std::size_t vertexCount,
                                       const std::string& field);

}  // namespace pellucid::harness
