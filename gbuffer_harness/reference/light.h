// Punctual lights and their shadow maps in double precision. World space, scene units.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"

namespace pellucid::harness::reference {

struct Arrival {
  glm::dvec3 toLight;     // unit, from the point
  glm::dvec3 irradiance;  // RGB on a surface facing the light
};

// KHR_lights_punctual: directional intensity is irradiance; point and spot give intensity / r^2 times
// the range window max(0, min(1, 1 - (r/range)^4)) and the spot's angular falloff. Tables of the light: as
// PellucidLight has them.
Arrival arrivalAt(const Light& light, const glm::dvec3& point);

// True where the light's maps hold the faces that light leaves by; all of them do, or none.
bool holdsBackFaces(const Light& light);

// A light's shadow map, asked where a point lies behind the surface it stores.
class ShadowView {
public:
  // Keeps references. Throws InputError when a matrix the encoding needs is missing or singular.
  ShadowView(const Light& light, const ShadowMap& map);

  enum class Kind {
    Outside,  // the point projects outside the map or lies behind the light
    Empty,    // the nearest texel stores no surface
    Surface
  };
  struct Lookup {
    Kind kind;
    double distance;       // along the light ray from the stored surface to the point; negative when the
                           // point is nearer to the light. Surface only
    double texel = 0;      // longer side of a texel across the light, scene units; perspective: where the ray
                           // through the map's middle is as long as that to the point. Not of Outside
    double uncertain = 0;  // scene units that distance may be off by; Surface only
    double exitUncertain = 0;  // likewise, of fromExit
    // From what lies beside the map; Surface only.
    std::optional<double> fromExit = {};     // as distance, from the exit depth; absent: none is known
    std::optional<int> casterMaterial = {};  // of the stored surface, 0: opaque; absent: not given
    bool clamped = false;                    // isClamped()
  };
  // The first of a light's maps that contains the point. A light of several maps has no seams: where none
  // does, the nearest one does if the point is at most half a texel outside. nullptr: no map does.
  static const ShadowView* find(const std::vector<ShadowView>& maps, const glm::dvec3& point);

  // Nearest texel; of the border, at most half a texel outside.
  Lookup at(const glm::dvec3& point) const;

  // The four texels around the point with their bilinear weights; nothing outside the map by more. In each
  // texel, the drawn depth is as far off the stored one as in the nearest texel.
  struct Tap {
    double weight;
    Lookup found;
  };
  std::optional<std::array<Tap, 4>> around(const glm::dvec3& point) const;

  // ---- Texels

  // The surface that a texel stores; absent where it holds nothing.
  std::optional<glm::dvec3> surfaceAt(int x, int y) const;
  // The point of the texel's ray that has a depth in the map's encoding.
  std::optional<glm::dvec3> pointAt(int x, int y, float stored) const;
  // True where it lies on the map's near plane, where engines clamp what lies before it: where light enters
  // is not known.
  bool isClamped(int x, int y) const;
  // Scene units along the light's ray that the texel's surface may be off by.
  double uncertain(int x, int y) const;
  // Area across the light's ray that a texel covers at a point, square scene units.
  double across(int x, int y, const glm::dvec3& point) const;
  bool contains(const glm::dvec3& point) const;

private:
  struct Projected {
    glm::dvec3 ndc;
    int x, y;       // texel
    double beyond;  // texels outside of the map, at most kSeam; not above 0 inside
  };
  static constexpr double kSeam = 0.5;
  struct Line {
    glm::dvec3 origin, direction;  // direction of travel, unit
    glm::dvec3 at(double t) const { return origin + t * direction; }
  };
  // The depth of the surface that was drawn into a texel, without the biases that the drawing added. In units
  // of the stored depth.
  struct DrawnDepth {
    double depth;
    double uncertain;  // how far it may be off
  };

  std::optional<Projected> project(const glm::dvec3& point) const;
  // The light's ray through continuous map coordinates.
  Line rayAt(double x, double y) const;
  glm::dvec3 unprojected(int x, int y, double stored) const;
  // As Lookup::distance, of a depth.
  double distanceFrom(const glm::dvec3& point, const Projected& p, double stored) const;
  bool holds(float stored) const;
  DrawnDepth drawnAt(int x, int y) const;  // of a texel that stores a surface
  // From what the nearest texel stores to what was drawn, in units of the stored depth.
  DrawnDepth moveAt(const Projected& p) const;
  // The lookup of texel (x, y).
  Lookup lookup(const glm::dvec3& point, const Projected& p, int x, int y, const DrawnDepth& move) const;
  double texelAt(const glm::dvec3& point, const Projected& p) const;
  double deviceDistance(const glm::dvec3& point, const Projected& p, double stored) const;
  double planarDistance(const glm::dvec3& point, double stored) const;
  double radialDistance(const glm::dvec3& point, double stored) const;

  const Light& light_;
  const ShadowMap& map_;
  glm::dmat4 clipFromWorld_, worldFromClip_, viewFromWorld_;
  bool perspective_;
  float nothing_;  // the end of 0..1 that lies away from the light, which the map was cleared to
};

}  // namespace pellucid::harness::reference
