#include "minimum_dot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera.h"

namespace pellucid {
namespace {

double alongAzimuth(const PellucidThesisOptions& t, double side, double front) {
  const double turns = std::atan2(side, front) / (2 * std::numbers::pi);
  const double at = (turns - std::floor(turns)) * t.minimumDotTableSize;
  const uint32_t i = static_cast<uint32_t>(at) % t.minimumDotTableSize;
  const double from = t.minimumDotTable[i], to = t.minimumDotTable[(i + 1) % t.minimumDotTableSize];
  return from + (to - from) * (at - std::floor(at));
}

double onSphere(const PellucidThesisOptions& t, const glm::dvec3& d) {
  const uint32_t n = t.minimumDotTableSize;
  const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  glm::dvec2 p = sum > 0 ? glm::dvec2(d.x, d.z) / sum : glm::dvec2(0);
  if (d.y < 0) p = {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
  const glm::dvec2 at = glm::clamp(0.5 * p + 0.5, 0.0, 1.0) * (n - 1.0);
  // The last cell also holds its far edge.
  const uint32_t x = std::min(static_cast<uint32_t>(at.x), n - 2),
                 y = std::min(static_cast<uint32_t>(at.y), n - 2);
  const auto entry = [&](uint32_t i, uint32_t j) {
    return static_cast<double>(t.minimumDotTable[j * n + i]);
  };
  const double upper = glm::mix(entry(x, y), entry(x + 1, y), at.x - x);
  const double lower = glm::mix(entry(x, y + 1), entry(x + 1, y + 1), at.x - x);
  return glm::mix(upper, lower, at.y - y);
}

}  // namespace

glm::dvec3 fromObject(const PellucidThesisOptions& t, const PellucidLight& light) {
  return light.type == PELLUCID_LIGHT_DIRECTIONAL ? -toVector(light.direction)
                                                  : toVector(light.position) - toVector(t.objectCenter);
}

double minimumDotOf(const PellucidThesisOptions& t, const PellucidLight& light) {
  const bool prescaled =
      t.prescaleAngle && t.angleModel >= PELLUCID_ANGLE_COSINE && t.angleModel <= PELLUCID_ANGLE_POLYNOMIAL;
  if (prescaled || t.angleModel == PELLUCID_ANGLE_MINIMUM_DOT) return t.minimumDot;
  if (minimumDotEntries(t) == 0) return 0;
  const glm::dvec3 up = glm::normalize(toVector(t.upAxis));
  const glm::dvec3 side = glm::normalize(glm::cross(up, toVector(t.faceVector))), front = glm::cross(side, up);
  glm::dvec3 d = fromObject(t, light);
  if (const double length = glm::length(d); length > 0) d /= length;
  const glm::dvec3 local(glm::dot(d, side), glm::dot(d, up), glm::dot(d, front));
  return t.angleModel == PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH ? alongAzimuth(t, local.x, local.z)
                                                            : onSphere(t, local);
}

uint32_t minimumDotEntries(const PellucidThesisOptions& t) {
  const uint32_t size = t.minimumDotTableSize;
  if (t.angleModel == PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH) return size <= kMostAzimuths ? size : 0;
  if (t.angleModel == PELLUCID_ANGLE_MINIMUM_DOT_SPHERE) return size <= kMostSphereSide ? size * size : 0;
  return 0;
}

}  // namespace pellucid
