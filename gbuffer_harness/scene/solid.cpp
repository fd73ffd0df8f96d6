#include "scene/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::harness {

namespace {

std::optional<Span> beginningAfter(double tMin, const Span& span) {
  return span.enter >= tMin ? std::optional(span) : std::nullopt;
}

}  // namespace

bool Solid::blocks(const Ray& ray, double tMin, double tMax) const {
  const std::optional<Span> span = firstSpan(ray, tMin);
  return span && span->enter <= tMax;
}

namespace {

// The span that holds the ray's origin; of convex solids, which have one span.
std::optional<Span> spanAround(const Solid& solid, const Ray& ray) {
  const std::optional<Span> span = solid.firstSpan(ray, -kInfinity);
  return span && span->enter <= 0 && span->exit > 0 ? span : std::nullopt;
}

}  // namespace

std::optional<double> Solid::exit(const Ray& ray, double limit) const {
  const std::optional<Span> span = spanAround(*this, ray);
  if (!span) return 0;
  return span->exit < limit ? std::optional(span->exit) : std::nullopt;
}

bool Solid::contains(const glm::dvec3& point) const {
  return spanAround(*this, {point, glm::dvec3(0, 0, 1)}).has_value();
}

Polyhedron Polyhedron::box(const glm::dvec3& center, const glm::dmat3& axes, const glm::dvec3& halfExtent) {
  std::vector<Plane> planes;
  for (int i = 0; i < 3; ++i) {
    if (std::isinf(halfExtent[i])) continue;
    const double middle = glm::dot(axes[i], center);
    planes.push_back({axes[i], middle + halfExtent[i]});
    planes.push_back({-axes[i], -middle + halfExtent[i]});
  }
  return Polyhedron(std::move(planes));
}

std::optional<Span> Polyhedron::firstSpan(const Ray& ray, double tMin) const {
  Span span{-kInfinity, kInfinity};
  for (const Plane& plane : planes_) {
    const double slope = glm::dot(plane.normal, ray.direction);
    const double gap = plane.offset - glm::dot(plane.normal, ray.origin);
    if (slope == 0) {
      if (gap < 0) return std::nullopt;
    } else if (slope < 0) {
      span.enter = std::max(span.enter, gap / slope);
    } else {
      span.exit = std::min(span.exit, gap / slope);
    }
  }
  if (!(span.enter < span.exit)) return std::nullopt;
  return beginningAfter(tMin, span);
}

glm::dvec3 Polyhedron::normal(const glm::dvec3& point) const {
  // The face of a surface point is the one whose plane it is least inside of.
  const auto face = std::max_element(planes_.begin(), planes_.end(), [&](const Plane& a, const Plane& b) {
    return glm::dot(a.normal, point) - a.offset < glm::dot(b.normal, point) - b.offset;
  });
  return face->normal;
}

std::optional<Span> Ellipsoid::firstSpan(const Ray& ray, double tMin) const {
  // In units of the radii the solid is a unit sphere. Half the chord comes from the distance between
  // line and center, which does not cancel when the eye is far away.
  const glm::dvec3 direction = ray.direction / radii_;
  const glm::dvec3 toCenter = (center_ - ray.origin) / radii_;
  const double square = glm::dot(direction, direction);
  const double middle = glm::dot(toCenter, direction) / square;
  const glm::dvec3 nearest = toCenter - middle * direction;
  const double rest = 1 - glm::dot(nearest, nearest);
  if (!(rest > 0)) return std::nullopt;
  const double half = std::sqrt(rest / square);
  return beginningAfter(tMin, {middle - half, middle + half});
}

glm::dvec3 Ellipsoid::normal(const glm::dvec3& point) const {
  return glm::normalize((point - center_) / (radii_ * radii_));
}

std::optional<Span> DistanceField::clipToBox(const Ray& ray) const {
  Span span{-kInfinity, kInfinity};
  for (int i = 0; i < 3; ++i) {
    if (ray.direction[i] == 0) {
      if (ray.origin[i] < boxMin_[i] || ray.origin[i] > boxMax_[i]) return std::nullopt;
      continue;
    }
    const double a = (boxMin_[i] - ray.origin[i]) / ray.direction[i];
    const double b = (boxMax_[i] - ray.origin[i]) / ray.direction[i];
    span.enter = std::max(span.enter, std::min(a, b));
    span.exit = std::min(span.exit, std::max(a, b));
  }
  if (!(span.enter < span.exit)) return std::nullopt;
  return span;
}

// From t, where sign * distance > 0, to where the surface is crossed; `end` when it is not.
double DistanceField::march(const Ray& ray, double t, double end, double sign) const {
  double before = t;
  double valueBefore = sign * distance(ray.at(t));
  if (valueBefore <= 0) return t;
  double value = valueBefore;
  while (value > 0) {
    if (t >= end) return end;
    before = t;
    valueBefore = value;
    t = std::min(end, t + std::max(value, smallestStep_));
    value = sign * distance(ray.at(t));
  }
  // False position, Illinois variant: halving the end that stays makes it converge superlinearly.
  double a = before, fa = valueBefore, b = t, fb = value;
  int side = 0;
  while (b - a > 1e-9) {
    const double x = std::clamp((a * fb - b * fa) / (fb - fa), a + 0.01 * (b - a), b - 0.01 * (b - a));
    const double fx = sign * distance(ray.at(x));
    if (fx > 0) {
      a = x, fa = fx;
      if (side == 1) fb /= 2;
      side = 1;
    } else {
      b = x, fb = fx;
      if (side == -1) fa /= 2;
      side = -1;
    }
    if (fx == 0) return x;
  }
  return (a + b) / 2;
}

// Where the first span after tMin begins inside the box, at most `end`.
double DistanceField::findEntry(const Ray& ray, const Span& box, double tMin, double end) const {
  double t = std::max(box.enter, tMin);
  if (box.enter < tMin && distance(ray.at(t)) <= 0) t = march(ray, t, end, -1) + smallestStep_;
  return march(ray, t, end, 1);
}

std::optional<Span> DistanceField::firstSpan(const Ray& ray, double tMin) const {
  const std::optional<Span> box = clipToBox(ray);
  if (!box || box->exit <= tMin) return std::nullopt;
  const double enter = findEntry(ray, *box, tMin, box->exit);
  if (enter >= box->exit) return std::nullopt;
  // Bracketing leaves the root on either side by 1e-9; begin the way out safely inside.
  const double exit = march(ray, std::min(enter + 2e-9, box->exit), box->exit, -1);
  return Span{enter, exit};
}

bool DistanceField::blocks(const Ray& ray, double tMin, double tMax) const {
  const std::optional<Span> box = clipToBox(ray);
  if (!box || box->exit <= tMin || box->enter >= tMax) return false;
  const double end = std::min(box->exit, tMax);
  return findEntry(ray, *box, tMin, end) < end;
}

std::optional<double> DistanceField::exit(const Ray& ray, double limit) const {
  const std::optional<Span> box = clipToBox(ray);
  if (!box || box->exit <= 0) return 0;
  const double end = std::min(limit, box->exit);
  const double t = march(ray, 0, end, -1);
  return t < limit ? std::optional(t) : std::nullopt;
}

bool DistanceField::contains(const glm::dvec3& point) const {
  for (int i = 0; i < 3; ++i)
    if (point[i] < boxMin_[i] || point[i] > boxMax_[i]) return false;
  return distance(point) < 0;
}

glm::dvec3 DistanceField::normal(const glm::dvec3& point) const {
  // Central differences; 1e-4 balances the field's curvature against rounding.
  constexpr double h = 1e-4;
  glm::dvec3 gradient;
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 offset(0);
    offset[i] = h;
    gradient[i] = distance(point + offset) - distance(point - offset);
  }
  return glm::normalize(gradient);
}

}  // namespace pellucid::harness
