#include "reference/footprint_integral.h"

#include <cmath>
#include <numbers>

namespace pellucid::harness::reference {
namespace {

// Gauss-Legendre, 8 points; Abramowitz & Stegun table 25.4.
constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                               0.1012285362903763};

// Longest stretch of w = asinh(s / D) that 8 points integrate.
constexpr double kPanel = 2;

// One edge's angle integral. With s along the edge and D its distance from the foot, s = D sinh w makes
// rho = D cosh w and dtheta = dw / cosh w: smooth however close or long the edge is.
void addEdge(const ProfileTable& profile, double distance, double from, double to, double height,
             const ProfileTable::Lanes& below, double sign, ProfileTable::Lanes& sum) {
  const double start = std::asinh(from / distance), length = std::asinh(to / distance) - start;
  const int panels = 1 + static_cast<int>(std::abs(length) / kPanel);
  const double half = 0.5 * length / panels;
  for (int panel = 0; panel < panels; ++panel)
    for (int i = 0; i < 8; ++i) {
      const double node = i < 4 ? kNode[i] : -kNode[i - 4], weight = kWeight[i % 4];
      const double coshW = std::cosh(start + half * (2 * panel + 1 + node));
      const double rho = distance * coshW;
      const ProfileTable::Lanes within = profile.cumulativeEnergy(std::sqrt(rho * rho + height * height));
      const double scale = sign * half * weight / coshW;
      sum += scale * (within - below);
    }
}

}  // namespace

ProfileTable::Lanes integratedEnergy(const ProfileTable& profile, const Parallelogram& p) {
  const glm::dvec3 normal = glm::normalize(glm::cross(p.x, p.y));
  const double height = glm::dot(p.center, normal);
  const glm::dvec3 foot = p.center - height * normal;
  const ProfileTable::Lanes below = profile.cumulativeEnergy(std::abs(height));
  const glm::dvec3 corner[4] = {foot - p.x - p.y, foot + p.x - p.y, foot + p.x + p.y, foot - p.x + p.y};
  ProfileTable::Lanes sum{0};
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3& a = corner[i];
    const glm::dvec3 edge = corner[(i + 1) % 4] - a;
    const double length = glm::length(edge);
    const glm::dvec3 along = edge / length;
    const double distance = glm::dot(glm::cross(a, along), normal);  // > 0: the foot is on the inner side
    // An edge through the foot sweeps no angle that encloses energy: its integral goes to 0 with D.
    if (std::abs(distance) < 1e-9 * length) continue;
    const double from = glm::dot(a, along);
    addEdge(profile, std::abs(distance), from, from + length, height, below, distance > 0 ? 1 : -1, sum);
  }
  return sum / (2 * std::numbers::pi);
}

ProfileTable::Lanes sampledEnergy(const ProfileTable& profile, const Parallelogram& p) {
  const double area = 4 * glm::length(glm::cross(p.x, p.y));
  ProfileTable::Lanes sum{0};
  for (const double a : {-std::numbers::inv_sqrt3, std::numbers::inv_sqrt3})
    for (const double b : {-std::numbers::inv_sqrt3, std::numbers::inv_sqrt3}) {
      const glm::dvec3 point = p.center + a * p.x + b * p.y;
      const double rSquared = glm::dot(point, point);
      if (!(rSquared < profile.radius() * profile.radius())) continue;
      sum += 0.25 * area * profile.value(rSquared);
    }
  return sum;
}

}  // namespace pellucid::harness::reference
