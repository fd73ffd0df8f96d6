#include "reference/light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <numbers>
#include <vector>

#include "common/error.h"
#include "reference/camera.h"
#include "scene/light_table.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

namespace {

double rangeWindow(double distance, double range) {
  if (!(range > 0)) return 1;
  return std::clamp(1 - std::pow(distance / range, 4), 0.0, 1.0);
}

// Reference implementation in the text of KHR_lights_punctual.
double coneFalloff(const Light& light, const glm::dvec3& toLight) {
  const double cosInner = std::cos(light.innerConeAngle), cosOuter = std::cos(light.outerConeAngle);
  const double scale = 1 / std::max(1e-6, cosInner - cosOuter);
  const double cosAngle = glm::dot(glm::normalize(toGlm(light.direction)), -toLight);
  const double t = std::clamp((cosAngle - cosOuter) * scale, 0.0, 1.0);
  return t * t;
}

double distanceFalloff(const Light& light, double distance) {
  if (light.distanceTable.empty()) return rangeWindow(distance, light.range);
  return distance < light.range ? factorAt(light.distanceTable, distance / light.range) : 0;
}

double angleFalloff(const Light& light, const glm::dvec3& toLight) {
  const double cone = light.type == PELLUCID_LIGHT_SPOT ? coneFalloff(light, toLight) : 1;
  if (light.angleTable.empty()) return cone;
  const double cosine = glm::dot(glm::normalize(toGlm(light.direction)), -toLight);
  return cone * factorAt(light.angleTable, std::acos(std::clamp(cosine, -1.0, 1.0)) / std::numbers::pi);
}

}  // namespace

Arrival arrivalAt(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 emitted = light.intensity * toGlm(light.color);
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) return {-glm::normalize(toGlm(light.direction)), emitted};
  const glm::dvec3 offset = toGlm(light.position) - point;
  const double distance = glm::length(offset);
  if (!(distance > 0)) return {glm::dvec3(0, 0, 1), glm::dvec3(0)};
  const glm::dvec3 toLight = offset / distance;
  const double falloff = angleFalloff(light, toLight) * distanceFalloff(light, distance);
  return {toLight, emitted * (falloff / (distance * distance))};
}

bool holdsBackFaces(const Light& light) {
  return !light.shadowMaps.empty() && light.shadowMaps.front().backFaces;
}

ShadowView::ShadowView(const Light& light, const ShadowMap& map)
    : light_(light),
      map_(map),
      clipFromWorld_(toGlm(map.clipFromWorld)),
      worldFromClip_(glm::inverse(clipFromWorld_)),
      viewFromWorld_(1.0) {
  const double determinant = glm::determinant(clipFromWorld_);
  if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
    throw InputError("", "shadowMap.clipFromWorld", "the matrix is singular");
  if (map.depth.image.empty()) throw InputError("", "shadowMap", "has no depth image");
  const bool needsView =
      map.depth.encoding == PELLUCID_DEPTH_VIEW_Z ||
      (map.depth.encoding == PELLUCID_DEPTH_DISTANCE && light.type == PELLUCID_LIGHT_DIRECTIONAL);
  if (needsView && !map.viewFromWorld)
    throw InputError("", "shadowMap.viewFromWorld", "missing, and the depth encoding needs it");
  if (map.viewFromWorld) viewFromWorld_ = toGlm(*map.viewFromWorld);
  const std::size_t texels = map.depth.image.pixels();
  if (!map.exitDepth.empty() && map.exitDepth.pixels() != texels)
    throw InputError("", "shadowMap.exit", "has another size than the map");
  if (!map.casterMaterial.empty() && map.casterMaterial.size() != texels)
    throw InputError("", "shadowMap.casterMaterial", "has another size than the map");
  perspective_ = clipFromWorld_[0][3] != 0 || clipFromWorld_[1][3] != 0 || clipFromWorld_[2][3] != 0;
  // Depth grows away from the light, or is reversed.
  const Line ray = rayAt(0.5 * map.depth.image.width, 0.5 * map.depth.image.height);
  const glm::dvec4 far = clipFromWorld_ * glm::dvec4(ray.at(1), 1),
                   near = clipFromWorld_ * glm::dvec4(ray.origin, 1);
  nothing_ = far.z * near.w > near.z * far.w ? 1.0f : 0.0f;
}

std::optional<ShadowView::Projected> ShadowView::project(const glm::dvec3& point) const {
  const glm::dvec4 clip = clipFromWorld_ * glm::dvec4(point, 1);
  if (!(clip.w > 0)) return std::nullopt;
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  const Image& image = map_.depth.image;
  const double px = (ndc.x * 0.5 + 0.5) * image.width, py = (ndc.y * 0.5 + 0.5) * image.height;
  const double beyond = std::max({-px, -py, px - image.width, py - image.height});
  if (!(beyond <= kSeam)) return std::nullopt;
  return Projected{ndc, std::clamp(static_cast<int>(std::floor(px)), 0, image.width - 1),
                   std::clamp(static_cast<int>(std::floor(py)), 0, image.height - 1), beyond};
}

const ShadowView* ShadowView::find(const std::vector<ShadowView>& maps, const glm::dvec3& point) {
  const ShadowView* nearest = nullptr;
  double least = INFINITY;
  for (const ShadowView& map : maps) {
    const std::optional<Projected> p = map.project(point);
    if (!p || (maps.size() == 1 && p->beyond > 0) || p->beyond >= least) continue;
    nearest = &map;
    least = p->beyond;
    if (p->beyond <= 0) break;
  }
  return nearest;
}

ShadowView::Line ShadowView::rayAt(double x, double y) const {
  const glm::dvec2 ndc(x / map_.depth.image.width * 2 - 1, y / map_.depth.image.height * 2 - 1);
  // Neither end of the depth range: an infinite one has no point there.
  const glm::dvec4 a = worldFromClip_ * glm::dvec4(ndc, 0.25, 1),
                   b = worldFromClip_ * glm::dvec4(ndc, 0.75, 1);
  const glm::dvec3 p = glm::dvec3(a) / a.w, q = glm::dvec3(b) / b.w;
  if (light_.type == PELLUCID_LIGHT_DIRECTIONAL) return {p, glm::normalize(toGlm(light_.direction))};
  const glm::dvec3 eye = toGlm(light_.position);
  return {eye, glm::normalize(0.5 * (p + q) - eye)};
}

bool ShadowView::holds(float stored) const {
  if (map_.depth.encoding != PELLUCID_DEPTH_DEVICE) return holdsSurface(stored);
  return stored >= 0 && stored <= 1 && stored != nothing_;
}

bool ShadowView::isClamped(int x, int y) const {
  if (map_.depth.encoding != PELLUCID_DEPTH_DEVICE) return false;
  const double stored = double(*map_.depth.image.at(x, y)), near = 1 - double(nothing_);
  return std::min(std::abs(stored - near), std::abs(stored - map_.depthBiasConstant - near)) <=
         std::max(map_.depthStep / 2, 1e-7);
}

ShadowView::DrawnDepth ShadowView::drawnAt(int x, int y) const {
  const Image& image = map_.depth.image;
  const double stored = double(*image.at(x, y)), bias = map_.depthBiasSlope;
  if (bias == 0) return {stored - map_.depthBiasConstant, map_.depthStep / 2};
  const auto neighbors = [&](int dx, int dy) {
    std::vector<double> depths;
    for (const int sign : {1, -1}) {
      const int nx = x + sign * dx, ny = y + sign * dy;
      if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height || !holds(*image.at(nx, ny))) continue;
      depths.push_back(double(*image.at(nx, ny)));
    }
    return depths;
  };
  const std::vector<double> axes[] = {neighbors(1, 0), neighbors(0, 1)};
  // The light grazes a triangle whose bias moves it behind both of a texel's neighbors.
  double moved = 0;
  for (const std::vector<double>& n : axes)
    if (n.size() == 2) {
      const double nearest = bias > 0 ? std::max(n[0], n[1]) : std::min(n[0], n[1]);
      moved = std::max(moved, (bias > 0 ? 1 : -1) * (stored - nearest));
    }
  const double own = stored - (bias > 0 ? moved : -moved);
  // Vulkan 1.3, "Depth Bias": the larger of the changes along x and y. Along each axis the nearer neighbor is
  // more likely of the same face; it shows 73 % of a sphere's slope at its limb.
  constexpr double kMissed = 0.3;
  double slope = 0, missed = 0;
  for (const std::vector<double>& n : axes) {
    if (n.empty()) continue;
    double least = std::abs(n[0] - own), other = least;
    if (n.size() == 2) {
      least = std::min(least, std::abs(n[1] - own));
      other = std::abs(n[0] + n[1] - 2 * own);
    }
    slope = std::max(slope, least);
    missed = std::max({missed, kMissed * least, other});
  }
  return {own - map_.depthBiasConstant - bias * slope,
          map_.depthStep / 2 + std::abs(bias) * (map_.depthStep + missed)};
}

std::optional<glm::dvec3> ShadowView::surfaceAt(int x, int y) const {
  if (!holds(*map_.depth.image.at(x, y))) return std::nullopt;
  return unprojected(x, y, drawnAt(x, y).depth) - map_.offsetLength * rayAt(x + 0.5, y + 0.5).direction;
}

std::optional<glm::dvec3> ShadowView::pointAt(int x, int y, float stored) const {
  return holds(stored) ? std::optional(unprojected(x, y, double(stored))) : std::nullopt;
}

double ShadowView::uncertain(int x, int y) const {
  const DrawnDepth d = drawnAt(x, y);
  if (!(d.uncertain > 0)) return 0;
  return glm::distance(unprojected(x, y, d.depth + d.uncertain), unprojected(x, y, d.depth));
}

glm::dvec3 ShadowView::unprojected(int x, int y, double stored) const {
  const Line ray = rayAt(x + 0.5, y + 0.5);
  if (map_.depth.encoding == PELLUCID_DEPTH_DEVICE) {
    const Image& image = map_.depth.image;
    const glm::dvec4 p = worldFromClip_ * glm::dvec4((x + 0.5) / image.width * 2 - 1,
                                                     (y + 0.5) / image.height * 2 - 1, stored, 1);
    return glm::dvec3(p) / p.w;
  }
  if (map_.depth.encoding == PELLUCID_DEPTH_DISTANCE && light_.type != PELLUCID_LIGHT_DIRECTIONAL)
    return ray.at(stored);
  const glm::dvec4 planar = -glm::row(viewFromWorld_, 2);
  const double from = glm::dot(planar, glm::dvec4(ray.origin, 1));
  return ray.at((stored - from) / glm::dot(glm::dvec3(planar), ray.direction));
}

double ShadowView::across(int x, int y, const glm::dvec3& point) const {
  const Line center = rayAt(x + 0.5, y + 0.5), right = rayAt(x + 1.5, y + 0.5),
             below = rayAt(x + 0.5, y + 1.5);
  if (light_.type == PELLUCID_LIGHT_DIRECTIONAL)
    return std::abs(
        glm::dot(glm::cross(right.origin - center.origin, below.origin - center.origin), center.direction));
  const double distance = glm::distance(point, center.origin);
  const glm::dvec3 solid = glm::cross(right.direction - center.direction, below.direction - center.direction);
  return std::abs(glm::dot(solid, center.direction)) * distance * distance;
}

bool ShadowView::contains(const glm::dvec3& point) const {
  const std::optional<Projected> p = project(point);
  return p && p->beyond <= 0;
}

double ShadowView::deviceDistance(const glm::dvec3& point, const Projected& p, double stored) const {
  const glm::dvec4 surface = worldFromClip_ * glm::dvec4(p.ndc.x, p.ndc.y, stored, 1);
  return glm::dot(point - glm::dvec3(surface) / surface.w, -arrivalAt(light_, point).toLight);
}

// The planar difference grows to the length of the ray between the two planes.
double ShadowView::planarDistance(const glm::dvec3& point, double stored) const {
  const glm::dvec3 inView(viewFromWorld_ * glm::dvec4(point, 1));
  const double planar = -inView.z;
  const double rayPerDepth = perspective_ ? glm::length(inView) / planar : 1;
  return (planar - stored) * rayPerDepth;
}

double ShadowView::radialDistance(const glm::dvec3& point, double stored) const {
  const double distance = light_.type == PELLUCID_LIGHT_DIRECTIONAL
                              ? -(viewFromWorld_ * glm::dvec4(point, 1)).z
                              : glm::distance(point, toGlm(light_.position));
  return distance - stored;
}

// Where the neighboring texels see the depth of the point.
double ShadowView::texelAt(const glm::dvec3& point, const Projected& p) const {
  const auto world = [&](const glm::dvec3& ndc) {
    const glm::dvec4 unprojected = worldFromClip_ * glm::dvec4(ndc, 1);
    return glm::dvec3(unprojected) / unprojected.w;
  };
  const glm::dvec3 right = p.ndc + glm::dvec3(2.0 / map_.depth.image.width, 0, 0);
  const glm::dvec3 below = p.ndc + glm::dvec3(0, 2.0 / map_.depth.image.height, 0);
  const double side = std::max(glm::distance(world(right), point), glm::distance(world(below), point));
  if (!perspective_) return side;
  const glm::dvec4 w(clipFromWorld_[0][3], clipFromWorld_[1][3], clipFromWorld_[2][3], clipFromWorld_[3][3]);
  const double planar = glm::dot(w, glm::dvec4(point, 1)) / glm::length(glm::dvec3(w));
  return side * glm::distance(point, toGlm(light_.position)) / planar;
}

double ShadowView::distanceFrom(const glm::dvec3& point, const Projected& p, double stored) const {
  switch (map_.depth.encoding) {
    case PELLUCID_DEPTH_VIEW_Z:
      return planarDistance(point, stored);
    case PELLUCID_DEPTH_DISTANCE:
      return radialDistance(point, stored);
    default:
      return deviceDistance(point, p, stored);
  }
}

ShadowView::DrawnDepth ShadowView::moveAt(const Projected& p) const {
  const float stored = *map_.depth.image.at(p.x, p.y);
  if (!holds(stored)) return {-map_.depthBiasConstant, map_.depthStep / 2};
  const DrawnDepth drawn = drawnAt(p.x, p.y);
  return {drawn.depth - double(stored), drawn.uncertain};
}

ShadowView::Lookup ShadowView::lookup(const glm::dvec3& point, const Projected& p, int x, int y,
                                      const DrawnDepth& move) const {
  Lookup found{Kind::Empty, 0};
  found.texel = texelAt(point, p);
  const float stored = *map_.depth.image.at(x, y);
  if (!holds(stored)) return found;
  found.kind = Kind::Surface;
  found.clamped = isClamped(x, y);
  const auto lengthOf = [&](double depth, double step) {
    return std::abs(distanceFrom(point, p, depth + step) - distanceFrom(point, p, depth));
  };
  found.distance = distanceFrom(point, p, double(stored) + move.depth) + map_.offsetLength;
  found.uncertain = lengthOf(double(stored), move.uncertain);
  if (!map_.exitDepth.empty()) {
    const float exit = *map_.exitDepth.at(x, y);
    if (holds(exit)) {
      found.fromExit = distanceFrom(point, p, double(exit));
      found.exitUncertain = lengthOf(double(exit), map_.depthStep);
    }
  }
  if (!map_.casterMaterial.empty())
    found.casterMaterial = map_.casterMaterial[pixelNumber(map_.depth.image, x, y)];
  return found;
}

ShadowView::Lookup ShadowView::at(const glm::dvec3& point) const {
  const std::optional<Projected> p = project(point);
  if (!p) return {Kind::Outside, 0};
  return lookup(point, *p, p->x, p->y, moveAt(*p));
}

std::optional<std::array<ShadowView::Tap, 4>> ShadowView::around(const glm::dvec3& point) const {
  const std::optional<Projected> p = project(point);
  if (!p) return std::nullopt;
  const Image& image = map_.depth.image;
  const glm::dvec2 place = (glm::dvec2(p->ndc) * 0.5 + 0.5) * glm::dvec2(image.width, image.height) - 0.5;
  const glm::dvec2 from = glm::floor(place), part = place - from;
  const DrawnDepth move = moveAt(*p);
  std::array<Tap, 4> taps;
  for (int i = 0; i < 4; ++i) {
    const int right = i & 1, down = i >> 1;
    const int x = std::clamp(static_cast<int>(from.x) + right, 0, image.width - 1);
    const int y = std::clamp(static_cast<int>(from.y) + down, 0, image.height - 1);
    taps[static_cast<std::size_t>(i)] = {(right ? part.x : 1 - part.x) * (down ? part.y : 1 - part.y),
                                         lookup(point, *p, x, y, move)};
  }
  return taps;
}

}  // namespace pellucid::harness::reference
