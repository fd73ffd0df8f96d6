#include "gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace pellucid::harness {

namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

// Calls visit with a value of the component type; false: there is no such type.
template <class Visit>
bool withType(int componentType, const Visit& visit) {
  switch (componentType) {
    case kByte:
      return visit(std::int8_t());
    case kUnsignedByte:
      return visit(std::uint8_t());
    case kShort:
      return visit(std::int16_t());
    case kUnsignedShort:
      return visit(std::uint16_t());
    case kUnsignedInt:
      return visit(std::uint32_t());
    case kFloat:
      return visit(float());
    default:
      return false;
  }
}

// Largest count of an accessor. Without a buffer view, nothing else bounds the number of zeros.
constexpr int kMostElements = 1 << 30, kMostZeros = 1 << 24;

struct Type {
  int components, componentType;
  bool normalized;
  std::size_t bytes;  // of an element
};

Type typeOf(const Field& components, int count, bool normalized) {
  Type type{count, components.integer(0, 1 << 16), normalized, 0};
  if (!withType(type.componentType, [&](auto value) { return (type.bytes = sizeof value * count) > 0; }))
    components.fail(components.shown() + " is no component type");
  return type;
}

Type typeOf(const Field& accessor) {
  constexpr int kComponents[] = {1, 2, 3, 4, 16};  // other matrices may have padding
  const Field type = accessor["type"], component = accessor["componentType"];
  const auto normalized = accessor.find("normalized");
  return typeOf(component, kComponents[type.choice({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"})],
                normalized && normalized->boolean());
}

int offsetOf(const Field& object) {
  const auto offset = object.find("byteOffset");
  return offset ? offset->integer(0, kMostElements) : 0;
}

// Elements that lie inside their buffer view.
struct Elements {
  Type type;
  const unsigned char* first;
  std::size_t stride;

  double operator()(std::size_t element, int i) const {
    const std::size_t size = type.bytes / static_cast<std::size_t>(type.components);
    const unsigned char* bytes = first + element * stride + static_cast<std::size_t>(i) * size;
    double result = 0;
    withType(type.componentType, [&](auto value) {
      std::memcpy(&value, bytes, sizeof value);  // not necessarily aligned
      result = static_cast<double>(value);
      // glTF 2.0, 3.6.2.2: a signed fraction's lowest value also is -1.
      using T = decltype(value);
      if (std::is_integral_v<T> && type.normalized)
        result = std::max(result / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
      return true;
    });
    return result;
  }
};

// `object`: what has "bufferView", and a "byteOffset" or none.
Elements elementsOf(const GltfDocument& document, const Field& object, const Type& type, std::size_t count) {
  const Field view = object["bufferView"];
  const GltfDocument::Bytes bytes = document.bufferView(view);
  Elements elements{type, nullptr, type.bytes};
  if (const auto stride = document.element("bufferViews", view).find("byteStride"))
    elements.stride = static_cast<std::size_t>(stride->integer(static_cast<int>(type.bytes), 252));
  const auto offset = static_cast<std::size_t>(offsetOf(object));
  // Divisions instead of products: a count must not wrap around.
  if (offset > bytes.size || bytes.size - offset < type.bytes ||
      (bytes.size - offset - type.bytes) / elements.stride < count - 1)
    object.fail(std::to_string(count) + " elements from byteOffset " + std::to_string(offset) + " leave the " +
                std::to_string(bytes.size) + " bytes of their view");
  elements.first = bytes.data + offset;
  return elements;
}

void requireUnsigned(const Field& field, const Type& type) {
  if (type.components != 1 || (type.componentType != kUnsignedByte && type.componentType != kUnsignedShort &&
                               type.componentType != kUnsignedInt))
    field.fail(field.shown() + " does not hold unsigned integers");
}

// The numbers of an accessor: in its buffer view, and in place of some those of a sparse part.
class Numbers {
public:
  Numbers(const GltfDocument& document, const Field& field)
      : accessor_(document.element("accessors", field)), type_(typeOf(accessor_)) {
    const auto sparse = accessor_.find("sparse");
    const bool isZero = sparse && !accessor_.has("bufferView");
    count_ = static_cast<std::size_t>(accessor_["count"].integer(1, isZero ? kMostZeros : kMostElements));
    if (!isZero) base_ = elementsOf(document, accessor_, type_, count_);
    if (sparse) readSparse(document, *sparse);
  }

  const Field& accessor() const { return accessor_; }
  std::size_t count() const { return count_; }
  const Type& type() const { return type_; }
  double operator()(std::size_t element, int i) const {
    const auto replaced = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (replaced != replaced_.end() && *replaced == element)
      return (*sparse_)(static_cast<std::size_t>(replaced - replaced_.begin()), i);
    return base_ ? (*base_)(element, i) : 0;
  }

private:
  void readSparse(const GltfDocument& document, const Field& sparse) {
    const auto count = static_cast<std::size_t>(sparse["count"].integer(1, kMostElements));
    const Field places = sparse["indices"];
    const Type integers = typeOf(places["componentType"], 1, false);
    requireUnsigned(places["componentType"], integers);
    const Elements indices = elementsOf(document, places, integers, count);
    sparse_ = elementsOf(document, sparse["values"], type_, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto index = static_cast<std::size_t>(indices(i, 0));
      if (index >= count_ || (i > 0 && index <= replaced_.back()))
        places.fail(std::to_string(index) + " at " + std::to_string(i) +
                    " does not follow the one before, or is not one of the " + std::to_string(count_) +
                    " elements");
      replaced_.push_back(index);
    }
  }

  const Field& accessor_;
  Type type_;
  std::size_t count_ = 0;
  std::optional<Elements> base_, sparse_;  // without the base: zeros
  std::vector<std::size_t> replaced_;      // ascending
};

}  // namespace

AccessorValues readFloats(const GltfDocument& document, const Field& field, int least, int most) {
  const Numbers numbers(document, field);
  AccessorValues values;
  values.components = numbers.type().components;
  if (values.components < least || values.components > most)
    field.fail(numbers.accessor().path() + " has " + std::to_string(values.components) + " components, not " +
               std::to_string(least) + (most > least ? " to " + std::to_string(most) : std::string()));
  values.data.reserve(numbers.count() * static_cast<std::size_t>(values.components));
  for (std::size_t i = 0; i < numbers.count(); ++i)
    for (int c = 0; c < values.components; ++c) {
      const double value = numbers(i, c);
      if (!std::isfinite(value))
        numbers.accessor().fail("element " + std::to_string(i) + " is not a finite number");
      values.data.push_back(static_cast<float>(value));
    }
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, const Field& field, std::size_t vertexCount) {
  const Numbers numbers(document, field);
  requireUnsigned(field, numbers.type());
  std::vector<std::uint32_t> indices(numbers.count());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const double value = numbers(i, 0);
    if (!(value < static_cast<double>(vertexCount)))
      numbers.accessor().fail("index " + std::to_string(static_cast<std::uint64_t>(value)) + " at " +
                              std::to_string(i) + " is not one of the " + std::to_string(vertexCount) +
                              " vertices");
    indices[i] = static_cast<std::uint32_t>(value);
  }
  return indices;
}

}  // namespace pellucid::harness
