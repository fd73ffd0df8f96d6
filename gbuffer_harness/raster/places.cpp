#include "raster/places.h"

#include <array>
#include <cmath>
#include <map>

namespace pellucid::harness {

std::vector<std::uint32_t> placesOf(const Model& model) {
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> places;
  for (const Vertex& vertex : model.vertices) {
    std::array<float, 3> position = vertex.position;
    for (float& x : position) x += 0.0f;  // -0 is 0
    places.push_back(numbers.emplace(position, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return places;
}

double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double divisor = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2 * std::atan2(glm::dot(a, glm::cross(b, c)), divisor);
}

}  // namespace pellucid::harness
