// Checks that structs of a frame have in common.
#pragma once

#include <cmath>

#include "camera.h"
#include "domains.h"
#include "findings.h"

namespace pellucid {

inline bool finite(const float* values, int count) {
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
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

// An affine, rigid transform: rotation, no scale. 1e-3 forgives float matrices built in several steps.
inline bool rigid(const glm::dmat4& m) {
  const glm::dmat3 r(m);
  const glm::dmat3 shouldBeIdentity = glm::transpose(r) * r;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i)
      if (std::abs(shouldBeIdentity[c][i] - (c == i ? 1.0 : 0.0)) > 1e-3) return false;
  return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

}  // namespace pellucid
