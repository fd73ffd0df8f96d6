// Structs that a caller of another version of the header made: shorter ones lack fields, longer ones have
// more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pellucid {

// A structSize above this is taken for garbage and not read from, as Linux's copy_struct_from_user does
// beyond a page.
constexpr size_t kLargestStruct = 4096;

// The size of a struct that ends before its first field that may be missing, which is `field`.
#define PELLUCID_LEAST_SIZE(Struct, field) offsetof(Struct, field)

// True for sizes that some version of the struct may have.
template <class Struct>
bool isStructSize(size_t size, size_t least) {
  return size >= least && size <= kLargestStruct && size % alignof(Struct) == 0;
}

// True where a caller's struct of that size can be read: `least` bytes or more, whole fields (pointers are
// the widest), and zeros where this library knows no fields.
template <class Struct>
bool canReadStruct(const Struct* given, size_t least) {
  const size_t size = given->structSize;
  if (!isStructSize<Struct>(size, least)) return false;
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  return size <= sizeof(Struct) ||
         std::all_of(bytes + sizeof(Struct), bytes + size, [](unsigned char byte) { return byte == 0; });
}

// The caller's fields over those of `defaults`.
template <class Struct>
Struct readStruct(const Struct* given, const Struct& defaults) {
  Struct result = defaults;
  std::memcpy(&result, given, std::min<size_t>(given->structSize, sizeof(Struct)));
  result.structSize = sizeof(Struct);
  return result;
}

// As much of `defaults` as the caller's struct holds, zeros where it holds more.
template <class Struct>
void writeStruct(Struct* given, size_t size, const Struct& defaults) {
  if (!given || size < sizeof given->structSize || size > kLargestStruct) return;
  std::memset(static_cast<void*>(given), 0, size);
  std::memcpy(static_cast<void*>(given), &defaults, std::min(size, sizeof(Struct)));
  given->structSize = static_cast<uint32_t>(size);
}

}  // namespace pellucid
