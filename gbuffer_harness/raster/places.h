// Positions of a mesh: shared vertices, and solid angles of its triangles.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

#include "raster/model.h"

namespace pellucid::harness {

// One number for all vertices at one position, so that seams of texture coordinates do not cut a mesh.
std::vector<std::uint32_t> placesOf(const Model& model);

// Signed solid angle of a triangle as seen from the origin of a, b and c. Van Oosterom & Strackee 1983, "The
// solid angle of a plane triangle".
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

// A closed surface spans 4 pi from each point inside and 0 from outside or from a hollow. A bowl spans up to
// half of it where nothing encloses a point; the eighth that may be missing is that of meshes with small
// holes.
inline constexpr double kEnclosed = 0.875 * 4 * std::numbers::pi;

}  // namespace pellucid::harness
