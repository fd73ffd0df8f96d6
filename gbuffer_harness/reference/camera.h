// The camera of a capture in double precision, read from its projection matrix alone.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "capture/capture.h"

namespace pellucid::harness::reference {

// Row by row.
inline std::size_t pixelNumber(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

// True when a viewZ or distance value holds a surface: positive, finite and below 1e9.
bool holdsSurface(float distance);

// Pixel coordinates are continuous: the center of pixel (x, y) is (x + 0.5, y + 0.5). Depth along the
// view axis ("planar") is positive in front of the eye, in scene units.
class Camera {
public:
  // Perspective, off-center, infinite or orthographic; either direction of depth. A perspective
  // matrix says which way it looks by its w row; an orthographic one looks along -z.
  // Throws InputError when z or w of the clip position depends on view x or y (oblique planes), or
  // when the matrix is singular.
  Camera(const Matrix& clipFromView, int width, int height);

  // Planar depth of a stored value; nothing for an empty pixel. A device depth is empty at or beyond
  // the far end of 0..1, which is what the depth buffer was cleared to.
  std::optional<double> planarDepth(float stored, PellucidDepthEncoding encoding) const;

  // View-space point seen at a pixel coordinate and planar depth.
  glm::dvec3 position(glm::dvec2 pixel, double planarDepth) const;

  // Unit vector along which the camera sees a view-space point: all points of a pixel lie along it. It is
  // that from the eye; of an orthographic camera one for all points, which a sheared matrix turns away from
  // the view axis.
  glm::dvec3 rayThrough(const glm::dvec3& viewPosition) const;

  // Pixel coordinates of a view-space point in front of the eye.
  glm::dvec2 project(const glm::dvec3& viewPosition) const;

  double planarDepth(const glm::dvec3& viewPosition) const { return forward_ * viewPosition.z; }
  bool orthographic() const { return orthographic_; }

private:
  glm::dmat4 clipFromView_;
  double width_, height_;
  bool orthographic_;
  double forward_;    // sign of view z in front of the eye
  double farDevice_;  // device depth of the far end: 1, or 0 when reversed
};

}  // namespace pellucid::harness::reference
