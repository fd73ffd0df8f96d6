#include "reference/shadow_texels.h"

#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#include "common/error.h"
#include "reference/camera.h"

namespace pellucid::harness::reference {
namespace {

glm::dvec3 toVector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

ShadowTexels::ShadowTexels(const Light& light, const ShadowMap& map)
    : light_(light), map_(map), clipFromWorld_(toMatrix(map.clipFromWorld)) {
  const double determinant = glm::determinant(clipFromWorld_);
  if (!(std::abs(determinant) > 0)) throw InputError("", "shadowMap.clipFromWorld", "the matrix is singular");
  worldFromClip_ = glm::inverse(clipFromWorld_);
  perspective_ = light.type != PELLUCID_LIGHT_DIRECTIONAL;
  if (map.viewFromWorld) viewFromWorld_ = toMatrix(*map.viewFromWorld);
  const bool planar = map.depth.encoding == PELLUCID_DEPTH_VIEW_Z ||
                      (map.depth.encoding == PELLUCID_DEPTH_DISTANCE && !perspective_);
  if (planar && !map.viewFromWorld)
    throw InputError("", "shadowMap.viewFromWorld", "missing, and the depth encoding needs it");
  // Depth grows away from the light, or is reversed.
  const Line ray = rayAt(0.5 * map.depth.image.width, 0.5 * map.depth.image.height);
  const glm::dvec4 far = clipFromWorld_ * glm::dvec4(ray.at(1), 1),
                   near = clipFromWorld_ * glm::dvec4(ray.origin, 1);
  nothing_ = far.z * near.w > near.z * far.w ? 1.0f : 0.0f;
}

ShadowTexels::Line ShadowTexels::rayAt(double x, double y) const {
  const glm::dvec2 ndc(x / map_.depth.image.width * 2 - 1, y / map_.depth.image.height * 2 - 1);
  // Neither end of the depth range: an infinite one has no point there.
  const glm::dvec4 a = worldFromClip_ * glm::dvec4(ndc, 0.25, 1),
                   b = worldFromClip_ * glm::dvec4(ndc, 0.75, 1);
  const glm::dvec3 p = glm::dvec3(a) / a.w, q = glm::dvec3(b) / b.w;
  if (!perspective_) return {p, glm::normalize(toVector(light_.direction))};
  const glm::dvec3 eye = toVector(light_.position);
  return {eye, glm::normalize(0.5 * (p + q) - eye)};
}

bool ShadowTexels::holds(float stored) const {
  if (map_.depth.encoding == PELLUCID_DEPTH_DEVICE) return stored >= 0 && stored <= 1 && stored != nothing_;
  return holdsSurface(stored);
}

DrawnDepth ShadowTexels::drawn(int x, int y) const {
  return drawnDepth(map_, x, y, [this](float stored) { return holds(stored); });
}

std::optional<glm::dvec3> ShadowTexels::at(int x, int y) const {
  if (!holds(*map_.depth.image.at(x, y))) return std::nullopt;
  return pointAt(x, y, drawn(x, y).depth) - map_.offsetLength * rayAt(x + 0.5, y + 0.5).direction;
}

std::optional<glm::dvec3> ShadowTexels::at(int x, int y, float stored) const {
  if (!holds(stored)) return std::nullopt;
  return pointAt(x, y, double(stored));
}

double ShadowTexels::uncertain(int x, int y) const {
  const DrawnDepth d = drawn(x, y);
  return d.uncertain > 0 ? glm::distance(pointAt(x, y, d.depth + d.uncertain), pointAt(x, y, d.depth)) : 0;
}

glm::dvec3 ShadowTexels::pointAt(int x, int y, double stored) const {
  const Line ray = rayAt(x + 0.5, y + 0.5);
  if (map_.depth.encoding == PELLUCID_DEPTH_DEVICE) {
    const Image& image = map_.depth.image;
    const glm::dvec4 p = worldFromClip_ * glm::dvec4((x + 0.5) / image.width * 2 - 1,
                                                     (y + 0.5) / image.height * 2 - 1, stored, 1);
    return glm::dvec3(p) / p.w;
  }
  if (map_.depth.encoding == PELLUCID_DEPTH_DISTANCE && perspective_) return ray.at(stored);
  const glm::dvec4 planar = -glm::row(viewFromWorld_, 2);
  const double from = glm::dot(planar, glm::dvec4(ray.origin, 1));
  const double perLength = glm::dot(glm::dvec3(planar), ray.direction);
  return ray.at((stored - from) / perLength);
}

double ShadowTexels::across(int x, int y, const glm::dvec3& point) const {
  const Line center = rayAt(x + 0.5, y + 0.5), right = rayAt(x + 1.5, y + 0.5),
             below = rayAt(x + 0.5, y + 1.5);
  if (!perspective_)
    return std::abs(
        glm::dot(glm::cross(right.origin - center.origin, below.origin - center.origin), center.direction));
  const double distance = glm::distance(point, center.origin);
  const glm::dvec3 solid = glm::cross(right.direction - center.direction, below.direction - center.direction);
  return std::abs(glm::dot(solid, center.direction)) * distance * distance;
}

}  // namespace pellucid::harness::reference
