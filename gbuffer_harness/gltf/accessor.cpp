#include "gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace pellucid::harness {

namespace {

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

// Elements of an accessor that lie inside its buffer view.
struct Elements {
  const unsigned char* first;
  std::size_t count, stride;
  int components, componentType;
  bool normalized;
};

// Largest count of an accessor whose only numbers other than 0 come from a sparse part.
constexpr std::size_t kMostZeros = 1u << 24;

// 0: matrices whose columns may have padding, and unknown types.
int componentsOf(const tinygltf::Accessor& accessor) {
  if (accessor.type == TINYGLTF_TYPE_MAT2 || accessor.type == TINYGLTF_TYPE_MAT3) return 0;
  return std::max(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)), 0);
}

// 0: unknown types.
std::size_t bytesOf(int componentType) {
  std::size_t bytes = 0;
  withType(componentType, [&](auto value) { return (bytes = sizeof value) > 0; });
  return bytes;
}

// Elements of a type in a buffer view. `name` is what describes them.
Elements elementsInView(const GltfDocument& document, int view, std::size_t byteOffset, std::size_t count,
                        const tinygltf::Accessor& type, const std::string& name) {
  const GltfDocument::Bytes bytes = document.bufferView(view, name);
  const std::size_t stride = document.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::string where = "bufferViews[" + std::to_string(view) + "]";
  Elements elements{nullptr, count, 0, componentsOf(type), type.componentType, type.normalized};
  const std::size_t size = bytesOf(elements.componentType) * static_cast<std::size_t>(elements.components);
  if (size == 0)
    document.fail(name, "type " + std::to_string(type.type) + " of component type " +
                            std::to_string(type.componentType) + " is not made of numbers");
  elements.stride = stride == 0 ? size : stride;
  if (elements.stride < size || elements.stride > 252)
    document.fail(where + ".byteStride",
                  std::to_string(stride) + " does not fit elements of " + std::to_string(size) + " bytes");
  if (count == 0) document.fail(name + ".count", "0 elements");
  // Divisions instead of products: a count near 2^64 must not wrap around.
  if (byteOffset > bytes.size || bytes.size - byteOffset < size ||
      (bytes.size - byteOffset - size) / elements.stride < count - 1)
    document.fail(name + ".count", std::to_string(count) + " elements from byteOffset " +
                                       std::to_string(byteOffset) + " leave the " +
                                       std::to_string(bytes.size) + " bytes of " + where);
  elements.first = bytes.data + byteOffset;
  return elements;
}

double component(const Elements& elements, std::size_t element, int i) {
  const unsigned char* bytes = elements.first + element * elements.stride +
                               static_cast<std::size_t>(i) * bytesOf(elements.componentType);
  double result = 0;
  withType(elements.componentType, [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);  // not necessarily aligned
    result = static_cast<double>(value);
    // glTF 2.0, 3.6.2.2: a signed fraction's lowest value also is -1.
    using T = decltype(value);
    if (std::is_integral_v<T> && elements.normalized)
      result = std::max(result / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
    return true;
  });
  return result;
}

void requireUnsigned(const GltfDocument& document, int components, int componentType,
                     const std::string& field, const std::string& name) {
  if (components != 1 || (componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                          componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                          componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    document.fail(field, name + " does not hold unsigned integers");
}

// The numbers of an accessor: in its buffer view or unpacked, and in place of some those of a sparse part.
class Numbers {
public:
  Numbers(const GltfDocument& document, int index, const std::string& field)
      : name_("accessors[" + std::to_string(index) + "]"),
        accessor_(document.model.accessors[document.index(index, document.model.accessors.size(), field,
                                                          "accessors")]) {
    if (accessor_.bufferView >= 0)
      base_ = elementsInView(document, accessor_.bufferView, accessor_.byteOffset, accessor_.count, accessor_,
                             name_);
    else if (accessor_.count == 0 || accessor_.count > kMostZeros)  // nothing else bounds the number of zeros
      document.fail(name_ + ".count", std::to_string(accessor_.count) + " is not within 1 .. 2^24");
    if (accessor_.sparse.isSparse) readSparse(document);
  }

  const std::string& name() const { return name_; }
  std::size_t count() const { return accessor_.count; }
  int components() const { return componentsOf(accessor_); }
  int componentType() const { return accessor_.componentType; }
  double operator()(std::size_t element, int i) const {
    const auto replaced = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (replaced != replaced_.end() && *replaced == element)
      return component(sparse_, static_cast<std::size_t>(replaced - replaced_.begin()), i);
    return base_.first ? component(base_, element, i) : 0;
  }

private:
  void readSparse(const GltfDocument& document) {
    const std::string field = name_ + ".sparse";
    const auto& sparse = accessor_.sparse;
    if (sparse.count < 0) document.fail(field + ".count", std::to_string(sparse.count) + " is negative");
    const auto count = static_cast<std::size_t>(sparse.count);
    tinygltf::Accessor integers;
    integers.type = TINYGLTF_TYPE_SCALAR;
    integers.componentType = sparse.indices.componentType;
    requireUnsigned(document, 1, integers.componentType, field + ".indices.componentType", field);
    const Elements indices = elementsInView(document, sparse.indices.bufferView,
                                            static_cast<std::size_t>(std::max(sparse.indices.byteOffset, 0)),
                                            count, integers, field + ".indices");
    sparse_ = elementsInView(document, sparse.values.bufferView,
                             static_cast<std::size_t>(std::max(sparse.values.byteOffset, 0)), count,
                             accessor_, field + ".values");
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<std::size_t>(component(indices, i, 0));
      if (index >= accessor_.count || (i > 0 && index <= replaced_.back()))
        document.fail(field + ".indices", std::to_string(index) + " at " + std::to_string(i) +
                                              " does not follow the one before, or is not one of the " +
                                              std::to_string(accessor_.count) + " elements");
      replaced_.push_back(index);
    }
  }

  std::string name_;
  const tinygltf::Accessor& accessor_;
  Elements base_{};  // without `first`: zeros
  Elements sparse_{};
  std::vector<std::size_t> replaced_;  // ascending
};

}  // namespace

AccessorValues readFloats(const GltfDocument& document, int accessor, int least, int most,
                          const std::string& field) {
  const Numbers numbers(document, accessor, field);
  if (numbers.components() < least || numbers.components() > most)
    document.fail(field, numbers.name() + " has " + std::to_string(numbers.components()) +
                             " components, not " + std::to_string(least) +
                             (most > least ? " to " + std::to_string(most) : std::string()));
  AccessorValues values;
  values.components = numbers.components();
  values.data.reserve(numbers.count() * static_cast<std::size_t>(values.components));
  for (std::size_t i = 0; i < numbers.count(); ++i)
    for (int c = 0; c < values.components; ++c) {
      const double value = numbers(i, c);
      if (!std::isfinite(value))
        document.fail(numbers.name(), "element " + std::to_string(i) + " is not a finite number");
      values.data.push_back(static_cast<float>(value));
    }
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, int accessor, std::size_t vertexCount,
                                       const std::string& field) {
  const Numbers numbers(document, accessor, field);
  requireUnsigned(document, numbers.components(), numbers.componentType(), field, numbers.name());
  std::vector<std::uint32_t> indices(numbers.count());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const double value = numbers(i, 0);
    if (!(value < static_cast<double>(vertexCount)))
      document.fail(numbers.name(), "index " + std::to_string(static_cast<std::uint64_t>(value)) + " at " +
                                        std::to_string(i) + " is not one of the " +
                                        std::to_string(vertexCount) + " vertices");
    indices[i] = static_cast<std::uint32_t>(value);
  }
  return indices;
}

}  // namespace pellucid::harness
