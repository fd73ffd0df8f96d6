// Values that the fields of the frame's structs may have. Validation checks these tables, docs/materials.md
// shows them, and tests/unit/domains_test.cpp tries what lies outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pellucid/pellucid_thesis.h"

namespace pellucid {

struct FloatDomain {
  const char* field;
  size_t offset;
  uint32_t count, row;  // floats; of a row, 0: there are no rows
  float least, most;
  bool leastIsOut;
  // True where the frame reads element `index` of the field in this struct; NULL: always. A value that is not
  // read may be anything.
  bool (*isRead)(const void* object, uint32_t index);
  const char* where;  // the same in words, NULL: always
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

template <class Struct>
Domains domainsOf();
template <>
Domains domainsOf<PellucidFrame>();
template <>
Domains domainsOf<PellucidThesisOptions>();
template <>
Domains domainsOf<PellucidMaterial>();
template <>
Domains domainsOf<PellucidLight>();
template <>
Domains domainsOf<PellucidLightTable>();
template <>
Domains domainsOf<PellucidShadowMap>();

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

}  // namespace pellucid
