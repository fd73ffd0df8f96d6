#include "scene/spline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::harness {

namespace {

constexpr int kSamplesPerSegment = 4;

}  // namespace

Spline::Spline(const std::vector<glm::dvec4>& controls, bool closed) : closed_(closed) {
  std::vector<glm::dvec4> p = controls;
  if (closed) {
    p.insert(p.end(), controls.begin(), controls.begin() + 3);
  } else {
    // Reflected end points make the curve begin and end at the outermost given ones.
    p.insert(p.begin(), 2.0 * controls[0] - controls[1]);
    p.push_back(2.0 * p.back() - p[p.size() - 2]);
  }
  for (std::size_t i = 0; i + 3 < p.size(); ++i) {
    segments_.push_back({(p[i] + 4.0 * p[i + 1] + p[i + 2]) / 6.0, (p[i + 2] - p[i]) / 2.0,
                         (p[i] - 2.0 * p[i + 1] + p[i + 2]) / 2.0,
                         (p[i + 3] - p[i] + 3.0 * (p[i + 1] - p[i + 2])) / 6.0});
  }
  const int count = static_cast<int>(segments_.size()) * kSamplesPerSegment + (closed ? 0 : 1);
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (int i = 0; i < count; ++i) {
    double u;
    const Segment& s = segmentAt(static_cast<double>(i) / kSamplesPerSegment, u);
    samples_.emplace_back(s.a + u * (s.b + u * (s.c + u * s.d)));
  }
  // A B-spline stays inside the hull of its control points.
  for (const glm::dvec4& control : p) {
    low = glm::min(low, glm::dvec2(control));
    high = glm::max(high, glm::dvec2(control));
  }
  center_ = (low + high) / 2.0;
  radius_ = glm::distance(low, high) / 2;
}

Spline::Nearest Spline::nearest(const glm::dvec2& point) const {
  std::size_t best = 0;
  double bestSquare = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double dx = samples_[i].x - point.x;
    const double dy = samples_[i].y - point.y;
    const double square = dx * dx + dy * dy;
    if (square < bestSquare) {
      bestSquare = square;
      best = i;
    }
  }
  // Newton on the derivative of the squared distance, kept between the neighboring samples.
  constexpr double kReach = 1.0 / kSamplesPerSegment;
  const double start = static_cast<double>(best) * kReach;
  double t = start;
  for (int i = 0; i < 5; ++i) {
    double u;
    const Segment& s = segmentAt(t, u);
    const glm::dvec2 b(s.b), c(s.c), d(s.d);
    const glm::dvec2 apart = glm::dvec2(s.a) + u * (b + u * (c + u * d)) - point;
    const glm::dvec2 first = b + u * (2.0 * c + u * 3.0 * d);
    const glm::dvec2 second = 2.0 * c + u * 6.0 * d;
    const double slope = glm::dot(first, first) + glm::dot(apart, second);
    // Where the distance has no minimum nearby (inside a bend) the Gauss-Newton step still descends.
    const double step = glm::dot(apart, first) / (slope > 0 ? slope : glm::dot(first, first));
    t = std::clamp(t - step, start - kReach, start + kReach);
    // Convergence is quadratic: the next step would be of the order of the square.
    if (std::abs(step) < 1e-6) break;
  }
  double u;
  const Segment& s = segmentAt(t, u);
  const glm::dvec4 value = s.a + u * (s.b + u * (s.c + u * s.d));
  const glm::dvec2 tangent(s.b + u * (2.0 * s.c + u * 3.0 * s.d));
  const glm::dvec2 away = point - glm::dvec2(value);
  const double distance = glm::length(away);
  return {value, distance, distance > 0 ? away / distance : glm::dvec2(0, 1),
          tangent.x * away.y - tangent.y * away.x > 0};
}

}  // namespace pellucid::harness
