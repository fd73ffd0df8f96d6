// Structs that a caller of another version of the header made: shorter ones lack fields, longer ones have
// more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "findings.h"
#include "pellucid/pellucid_thesis.h"

namespace pellucid {

// The structs of the API that callers fill: the values of fields that callers leave alone, and the size of a
// struct that ends before its first field that may be missing.
PellucidFrame defaultFrame();
PellucidThesisOptions defaultThesisOptions();
PellucidContextDesc defaultContextDesc();
constexpr size_t kLeastFrame = offsetof(PellucidFrame, options);
constexpr size_t kLeastMaterial = offsetof(PellucidMaterial, burleyDistance);
constexpr size_t kLeastThesisOptions = offsetof(PellucidThesisOptions, angleModel);
constexpr size_t kLeastContextDesc = offsetof(PellucidContextDesc, options);

// A structSize above this is taken for garbage and not read from, as Linux's copy_struct_from_user does
// beyond a page.
constexpr size_t kLargestStruct = 4096;

// True for sizes that some version of the struct may have: whole fields, of which pointers are the widest.
template <class Struct>
bool isStructSize(size_t size, size_t least) {
  return size >= least && size <= kLargestStruct && size % alignof(Struct) == 0;
}

// True where a caller's struct can be read, with zeros where this library knows no fields.
template <class Struct>
bool canReadStruct(const Struct* given, size_t least) {
  const size_t size = given->structSize;
  if (!isStructSize<Struct>(size, least)) return false;
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  return size <= sizeof(Struct) ||
         std::all_of(bytes + sizeof(Struct), bytes + size, [](unsigned char byte) { return byte == 0; });
}

// The same, with an error. `init`: the function that writes the size.
template <class Struct>
bool checkStructSize(const Struct* given, size_t least, const char* field, const char* init, Findings& out) {
  if (canReadStruct(given, least)) return true;
  out.fail(PELLUCID_ERROR_VERSION, field, "is ", given->structSize, "; this library reads ", least, " to ",
           sizeof(Struct), " bytes, and more if they are 0 (call ", init, ")");
  return false;
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
