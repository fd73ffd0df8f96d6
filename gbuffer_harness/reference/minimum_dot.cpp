#include "reference/minimum_dot.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "common/error.h"

namespace pellucid::harness::reference {
namespace {

template <class T>
glm::dvec3 vec(const std::array<T, 3>& a) {
  return {double(a[0]), double(a[1]), double(a[2])};
}

// Weighs the two entries on either side of the light's angle about the up axis.
double byAzimuth(const std::vector<float>& table, double sideways, double ahead) {
  const double step = 360.0 / double(table.size());
  double degrees = std::atan2(sideways, ahead) * 180 / std::numbers::pi;
  if (degrees < 0) degrees += 360;
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    double apart = std::abs(degrees - double(i) * step);
    apart = std::min(apart, 360 - apart);
    sum += double(table[i]) * std::max(0.0, 1 - apart / step);
  }
  return table.size() == 1 ? double(table[0]) : sum;
}

// Tent weights of all entries at the direction's place on the unfolded octahedron.
double bySphere(const std::vector<float>& table, const glm::dvec3& local) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(table.size()))));
  const double length = std::abs(local.x) + std::abs(local.y) + std::abs(local.z);
  double x = length > 0 ? local.x / length : 0, y = length > 0 ? local.z / length : 0;
  if (local.y < 0) {
    const double foldedX = (x < 0 ? -1 : 1) * (1 - std::abs(y));
    y = (y < 0 ? -1 : 1) * (1 - std::abs(x));
    x = foldedX;
  }
  const double spacing = 2.0 / double(side - 1);
  double sum = 0;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i)
      sum += double(table[j * side + i]) *
             std::max(0.0, 1 - std::abs(x - (double(i) * spacing - 1)) / spacing) *
             std::max(0.0, 1 - std::abs(y - (double(j) * spacing - 1)) / spacing);
  return sum;
}

}  // namespace

double minimumDot(const TranslucencySettings& s, const Light& light) {
  const bool azimuth = s.angleModel == PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH;
  if (!azimuth && s.angleModel != PELLUCID_ANGLE_MINIMUM_DOT_SPHERE) return double(s.minimumDot);
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(s.minimumDotTable.size()))));
  if (s.minimumDotTable.empty() || (!azimuth && (side < 3 || side * side != s.minimumDotTable.size())))
    throw InputError("", "minimumDotTable",
                     std::to_string(s.minimumDotTable.size()) + " entries do not fit the angle model");
  glm::dvec3 toLight = light.type == PELLUCID_LIGHT_DIRECTIONAL ? -vec(light.direction)
                                                                : vec(light.position) - vec(s.objectCenter);
  if (glm::length(toLight) > 0) toLight = glm::normalize(toLight);
  const glm::dvec3 up = glm::normalize(vec(s.upAxis));
  const glm::dvec3 sideways = glm::normalize(glm::cross(up, vec(s.faceVector)));
  const glm::dvec3 ahead = glm::cross(sideways, up);
  const glm::dvec3 local(glm::dot(toLight, sideways), glm::dot(toLight, up), glm::dot(toLight, ahead));
  return azimuth ? byAzimuth(s.minimumDotTable, local.x, local.z) : bySphere(s.minimumDotTable, local);
}

}  // namespace pellucid::harness::reference
