// Numbers of accessors, checked against the bytes that there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/document.h"

namespace pellucid::harness {

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
