// Uniform cubic B-splines and the point of one nearest to a given point of the xy plane.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace pellucid::harness {

// A curve over the xy plane that carries two more quantities along (z, w).
class Spline {
public:
  // A closed spline wraps around; an open one runs from the first to the last control point.
  Spline(const std::vector<glm::dvec4>& controls, bool closed);

  struct Nearest {
    glm::dvec4 value;  // of the curve there
    double distance;   // in the xy plane
    glm::dvec2 away;   // unit, from the curve to the point
    bool left;         // whether the point is to the left of the direction of travel
  };
  Nearest nearest(const glm::dvec2& point) const;

  // A lower bound on nearest(point).distance, from the circle around the curve.
  double atLeast(const glm::dvec2& point) const { return glm::distance(point, center_) - radius_; }

private:
  // a + b u + c u^2 + d u^3 for u in 0 .. 1.
  struct Segment {
    glm::dvec4 a, b, c, d;
  };
  // The segment that holds parameter t, and t's fraction in it. Parameters are whole numbers at the
  // segments' ends; t is at most one turn outside a closed curve.
  const Segment& segmentAt(double t, double& u) const {
    const auto length = static_cast<double>(segments_.size());
    if (closed_) {
      if (t < 0) t += length;
      if (t >= length) t -= length;
    } else {
      t = std::clamp(t, 0.0, length);
    }
    const auto index = std::min(static_cast<std::size_t>(t), segments_.size() - 1);
    u = t - static_cast<double>(index);
    return segments_[index];
  }

  std::vector<Segment> segments_;
  bool closed_;
  std::vector<glm::dvec2> samples_;
  glm::dvec2 center_;
  double radius_;
};

}  // namespace pellucid::harness
