// Geometry of a capture, pixel by pixel: what the depths and normals say in double precision.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "capture/capture.h"
#include "reference/camera.h"

namespace pellucid::harness::reference {

// View space, scene units.
struct Surface {
  glm::dvec3 position;
  glm::dvec3 ray;                    // unit, from the eye to the position
  std::optional<glm::dvec3> normal;  // unit, outward; absent when the capture's is missing, 0 or not finite
  glm::ivec2 pixel;
  std::optional<double> chord;  // length of the ray between the front and back surface, > 0
};

class SurfaceReader {
public:
  // Keeps a reference to the capture. Throws InputError when an image is missing or has the wrong size.
  explicit SurfaceReader(const Capture& capture);

  // Nothing where the front depth holds nothing. Pixel center of (x, y).
  std::optional<Surface> at(int x, int y) const;

  // Unit normals of the front and back depths at the surface's pixel, view space, towards the eye; nothing
  // where depths span no plane.
  std::optional<glm::dvec3> facet(const Surface& surface) const;
  std::optional<glm::dvec3> backFacet(const Surface& surface) const;

  // Parallelogram of the surface's tangent plane that the pixel covers: its two half-axes, scene
  // units, view space. Tilted planes tile without gaps. Planes seen more obliquely than
  // kLeastCosine are turned towards the eye until they are not, so no pixel stands for more than
  // 1/kLeastCosine times the area facing the eye.
  struct Footprint {
    glm::dvec3 halfX, halfY;
  };
  static constexpr double kLeastCosine = 0.05;
  Footprint footprint(int x, int y, const Surface& surface) const;

  double millimetersPerUnit() const { return 1000 * capture_.metersPerUnit; }
  const Camera& camera() const { return camera_; }
  const glm::dmat4& worldFromView() const { return worldFromView_; }

private:
  std::optional<glm::dvec3> normalAt(int x, int y) const;
  std::optional<double> planarDepth(const DepthImage& depth, int x, int y) const;
  glm::dvec3 slopeAlong(const DepthImage& depth, int x, int y, int stepX, int stepY,
                        const glm::dvec3& position) const;
  // Unit, towards the eye; absent where depths span no plane. `position`: of the surface at the pixel.
  std::optional<glm::dvec3> normalFromDepth(const DepthImage& depth, int x, int y,
                                            const glm::dvec3& position) const;
  // Displacement of one pixel's step at the surface's distance, facing the camera.
  glm::dvec3 flatStep(int x, int y, const glm::dvec3& position, const glm::dvec2& step) const;

  const Capture& capture_;
  Camera camera_;
  glm::dmat4 viewFromWorld_, worldFromView_;
};

}  // namespace pellucid::harness::reference
