// Values that the fields of the frame's structs may have. Validation checks these tables, docs/materials.md
// shows them, and tests/unit/domains_test.cpp tries what lies outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "findings.h"
#include "pellucid/pellucid_thesis.h"

namespace pellucid {

struct FloatDomain {
  const char* field;
  size_t offset;
  uint32_t count;  // floats
  float least, most;
  bool leastIsOut = false;
  // True where the frame reads element `index` of the field in this struct; NULL: always. A value that is not
  // read may be anything.
  bool (*isRead)(const void* object, uint32_t index) = nullptr;
  const char* where = nullptr;  // the same in words, NULL: always
  uint32_t row = 0;             // floats of a row, 0: there are no rows
};

struct IntegerDomain {
  const char* field;
  size_t offset;
  uint32_t count, least, most;
};

struct Domains {
  std::span<const FloatDomain> floats;
  std::span<const IntegerDomain> integers;
};

// Of PellucidFrame, PellucidThesisOptions, PellucidMaterial, PellucidLight, PellucidLightTable and
// PellucidShadowMap.
template <class Struct>
Domains domainsOf();

// True where the frame reads the light's direction.
inline bool hasDirection(const PellucidLight& light) {
  return light.type != PELLUCID_LIGHT_POINT || light.angleTable > 0;
}

// Element `index` of the field.
inline float valueOf(const FloatDomain& d, const void* object, uint32_t index) {
  return reinterpret_cast<const float*>(static_cast<const std::byte*>(object) + d.offset)[index];
}
inline uint32_t valueOf(const IntegerDomain& d, const void* object, uint32_t index) {
  return reinterpret_cast<const uint32_t*>(static_cast<const std::byte*>(object) + d.offset)[index];
}

// False for NaN, too.
inline bool contains(const FloatDomain& d, float value) {
  return (d.leastIsOut ? value > d.least : value >= d.least) && value <= d.most;
}
inline bool isRead(const FloatDomain& d, const void* object, uint32_t index) {
  return !d.isRead || d.isRead(object, index);
}

// Fields outside their domains, each named behind `prefix`. Integers first, which say what else is read.
template <class Struct>
void checkDomains(const Struct& object, const char* prefix, Findings& out) {
  bool allIntegers = true;
  for (const IntegerDomain& d : domainsOf<Struct>().integers)
    for (uint32_t i = 0; i < d.count; ++i) {
      const uint32_t value = valueOf(d, &object, i);
      if (value >= d.least && value <= d.most) continue;
      const Field element = d.count == 1 ? Field("") : Field("[", i, "] ");
      out.error(Field(prefix, d.field), element, "is ", value, ", outside ", d.least, "..", d.most);
      allIntegers = false;
    }
  if (!allIntegers) return;
  for (const FloatDomain& d : domainsOf<Struct>().floats)
    for (uint32_t i = 0; i < d.count; ++i) {
      const float value = valueOf(d, &object, i);
      if (!isRead(d, &object, i) || contains(d, value)) continue;
      const Field element = d.count == 1 ? Field("")
                            : d.row == 0 ? Field("[", i, "] ")
                                         : Field("[", i / d.row, "][", i % d.row, "] ");
      out.error(Field(prefix, d.field), element, "is ", value, ", outside ", d.leastIsOut ? "(" : "[",
                d.least, ", ", d.most, "]");
    }
}

}  // namespace pellucid
