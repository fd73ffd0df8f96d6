#include "gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pellucid::harness {

namespace {

// Elements of an accessor that lie inside its buffer view.
struct Elements {
  const unsigned char* first;
  std::size_t count, stride;
  int components, componentType;
  bool normalized;
};

int componentsOf(const tinygltf::Accessor& accessor) {
  switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;  // matrices
  }
}

std::size_t bytesOf(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

Elements elementsOf(const GltfDocument& document, int accessorIndex, const std::string& field) {
  const auto& accessors = document.model.accessors;
  const tinygltf::Accessor& accessor =
      accessors[document.index(accessorIndex, accessors.size(), field, "accessors")];
  const std::string name = "accessors[" + std::to_string(accessorIndex) + "]";
  if (accessor.sparse.isSparse) document.fail(name + ".sparse", "sparse accessors are not supported");
  const GltfDocument::Bytes view = document.bufferView(accessor.bufferView, name);
  const std::size_t stride =
      document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;

  Elements elements{
      nullptr, accessor.count, 0, componentsOf(accessor), accessor.componentType, accessor.normalized};
  const std::size_t size = bytesOf(elements.componentType) * static_cast<std::size_t>(elements.components);
  if (size == 0)
    document.fail(name, "type " + std::to_string(accessor.type) + " of component type " +
                            std::to_string(accessor.componentType) + " is not a scalar or vector of numbers");
  elements.stride = stride == 0 ? size : stride;
  if (elements.stride < size || elements.stride > 252)
    document.fail("bufferViews[" + std::to_string(accessor.bufferView) + "].byteStride",
                  std::to_string(stride) + " does not fit elements of " + std::to_string(size) + " bytes");
  if (accessor.count == 0) document.fail(name + ".count", "0 elements");
  // Divisions instead of products: a count near 2^64 must not wrap around.
  if (accessor.byteOffset > view.size || view.size - accessor.byteOffset < size ||
      (view.size - accessor.byteOffset - size) / elements.stride < accessor.count - 1)
    document.fail(name + ".count", std::to_string(accessor.count) + " elements from byteOffset " +
                                       std::to_string(accessor.byteOffset) + " leave the " +
                                       std::to_string(view.size) + " bytes of bufferViews[" +
                                       std::to_string(accessor.bufferView) + "]");
  elements.first = view.data + accessor.byteOffset;
  return elements;
}

template <class T>
double load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // not necessarily aligned
  return static_cast<double>(value);
}

double component(const Elements& elements, std::size_t element, int i) {
  const unsigned char* bytes = elements.first + element * elements.stride +
                               static_cast<std::size_t>(i) * bytesOf(elements.componentType);
  // glTF 2.0, 3.6.2.2: a signed fraction's lowest value also is -1.
  const auto fraction = [&](double value, double most) {
    return elements.normalized ? std::max(value / most, -1.0) : value;
  };
  switch (elements.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return fraction(load<std::int8_t>(bytes), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return fraction(load<std::uint8_t>(bytes), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return fraction(load<std::int16_t>(bytes), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return fraction(load<std::uint16_t>(bytes), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return fraction(load<std::uint32_t>(bytes), 4294967295.0);
    default:
      return load<float>(bytes);
  }
}

}  // namespace

AccessorValues readFloats(const GltfDocument& document, int accessor, int least, int most,
                          const std::string& field) {
  const Elements elements = elementsOf(document, accessor, field);
  const std::string name = "accessors[" + std::to_string(accessor) + "]";
  if (elements.components < least || elements.components > most)
    document.fail(field, name + " has " + std::to_string(elements.components) + " components, not " +
                             std::to_string(least) +
                             (most > least ? " to " + std::to_string(most) : std::string()));
  AccessorValues values;
  values.components = elements.components;
  values.data.reserve(elements.count * static_cast<std::size_t>(elements.components));
  for (std::size_t i = 0; i < elements.count; ++i)
    for (int c = 0; c < elements.components; ++c) {
      const double value = component(elements, i, c);
      if (!std::isfinite(value))
        document.fail(name, "element " + std::to_string(i) + " is not a finite number");
      values.data.push_back(static_cast<float>(value));
    }
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, int accessor, std::size_t vertexCount,
                                       const std::string& field) {
  const Elements elements = elementsOf(document, accessor, field);
  const std::string name = "accessors[" + std::to_string(accessor) + "]";
  if (elements.components != 1 || (elements.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                   elements.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                   elements.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    document.fail(field, name + " does not hold unsigned integers");
  std::vector<std::uint32_t> indices(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    const double value = component(elements, i, 0);
    if (!(value < static_cast<double>(vertexCount)))
      document.fail(name, "index " + std::to_string(static_cast<std::uint64_t>(value)) + " at " +
                              std::to_string(i) + " is not one of the " + std::to_string(vertexCount) +
                              " vertices");
    indices[i] = static_cast<std::uint32_t>(value);
  }
  return indices;
}

}  // namespace pellucid::harness
