// Texels of a light's shadow map in double precision. World space, scene units.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "capture/capture.h"
#include "reference/drawn_depth.h"

namespace pellucid::harness::reference {

class ShadowTexels {
public:
  // Keeps references. Throws InputError when a matrix that the encoding needs is missing or singular.
  ShadowTexels(const Light& light, const ShadowMap& map);

  // The surface that a texel stores; absent where it holds nothing.
  std::optional<glm::dvec3> at(int x, int y) const;
  // The point of the texel's ray that has a depth in the map's encoding.
  std::optional<glm::dvec3> at(int x, int y, float stored) const;
  // Scene units along the light's ray that the texel's surface may be off by.
  double uncertain(int x, int y) const;

  // Area across the light's ray that a texel covers at a point, square scene units.
  double across(int x, int y, const glm::dvec3& point) const;

private:
  struct Line {
    glm::dvec3 origin, direction;  // direction of travel, unit
    glm::dvec3 at(double t) const { return origin + t * direction; }
  };
  bool holds(float stored) const;
  glm::dvec3 pointAt(int x, int y, double stored) const;
  DrawnDepth drawn(int x, int y) const;
  // The light's ray through continuous map coordinates.
  Line rayAt(double x, double y) const;

  const Light& light_;
  const ShadowMap& map_;
  glm::dmat4 clipFromWorld_, worldFromClip_{1}, viewFromWorld_{1};
  bool perspective_;
  float nothing_;
};

}  // namespace pellucid::harness::reference
