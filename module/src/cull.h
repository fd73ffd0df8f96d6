// Lights that cannot add to any pixel of a frame, decided without its images. Pure, double inside.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "setup.h"

namespace pellucid {

// The part of space that the render rect can show: every surface lies on a ray start + p direction, p > 0.
// View space.
class ViewBounds {
public:
  explicit ViewBounds(const Setup& setup);  // which outlives it

  // Why a light adds nothing to the frame, or nullptr. Static string. Everything is conservative: a light
  // that could add to one pixel stays.
  const char* whySkipped(const PellucidLight& light) const;

private:
  bool angleStops(const PellucidLight& light) const;
  bool rangeMisses(const PellucidLight& light) const;
  bool coneMisses(const PellucidLight& light) const;

  // Surfaces lie where dot(normal, x) >= offset.
  struct Plane {
    glm::dvec3 normal{0};  // unit
    double offset = 0;
  };

  const Setup& setup_;
  bool bounded_ = false;  // false: a projection whose rays neither share a start nor a direction
  bool parallel_ = false;
  double forward_ = 0;
  std::array<glm::dvec3, 4> starts_{};
  glm::dvec3 axis_{0};    // of a cone around all rays
  double halfAngle_ = 0;  // radians; infinite: no such cone
  std::array<Plane, 5> planes_{};
};

}  // namespace pellucid
