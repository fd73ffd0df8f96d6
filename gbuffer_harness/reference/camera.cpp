#include "reference/camera.h"

#include <cmath>

#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

bool holdsSurface(float distance) { return distance > 0 && distance < 1e9f; }

Camera::Camera(const Matrix& clipFromView, int width, int height)
    : clipFromView_(toGlm(clipFromView)), width_(width), height_(height) {
  const glm::dmat4& m = clipFromView_;
  const std::string field = "camera.clipFromView";
  if (m[0][2] != 0 || m[1][2] != 0 || m[0][3] != 0 || m[1][3] != 0)
    throw InputError("", field, "clip z and w must not depend on view x and y (oblique clip planes)");
  const double determinant = glm::determinant(m);
  if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
    throw InputError("", field, "the matrix is singular");
  orthographic_ = m[2][3] == 0;
  forward_ = orthographic_ || m[2][3] < 0 ? -1 : 1;
  // d(device depth)/d(planar depth) has the sign of this expression everywhere in front of the eye.
  const double slope = forward_ * (m[2][2] * m[3][3] - m[3][2] * m[2][3]);
  farDevice_ = slope > 0 ? 1 : 0;
}

std::optional<double> Camera::planarDepth(float stored, PellucidDepthEncoding encoding) const {
  if (encoding == PELLUCID_DEPTH_VIEW_Z)
    return holdsSurface(stored) ? std::optional<double>(stored) : std::nullopt;
  if (!(stored >= 0 && stored <= 1) || stored == farDevice_) return std::nullopt;
  const glm::dmat4& m = clipFromView_;
  const double z = (m[3][2] - stored * m[3][3]) / (stored * m[2][3] - m[2][2]);
  const double depth = forward_ * z;
  // An orthographic camera may stand anywhere along its rays: its depths have no sign to check.
  const bool usable = std::abs(depth) < 1e9 && (orthographic_ ? depth != 0 : depth > 0);
  return usable ? std::optional<double>(depth) : std::nullopt;
}

glm::dvec3 Camera::position(glm::dvec2 pixel, double planarDepth) const {
  const glm::dmat4& m = clipFromView_;
  const double z = forward_ * planarDepth;
  const double w = m[2][3] * z + m[3][3];
  const glm::dvec2 ndc(pixel.x / width_ * 2 - 1, pixel.y / height_ * 2 - 1);
  const glm::dmat2 clipFromPlane(m[0][0], m[0][1], m[1][0], m[1][1]);
  const glm::dvec2 offset(m[2][0] * z + m[3][0], m[2][1] * z + m[3][1]);
  const glm::dvec2 xy = glm::inverse(clipFromPlane) * (ndc * w - offset);
  return {xy, z};
}

glm::dvec3 Camera::rayThrough(const glm::dvec3& viewPosition) const {
  if (!orthographic_) return glm::normalize(viewPosition);
  const glm::dmat4& m = clipFromView_;
  const glm::dmat2 clipFromPlane(m[0][0], m[0][1], m[1][0], m[1][1]);
  return forward_ * glm::normalize(glm::dvec3(-(glm::inverse(clipFromPlane) * glm::dvec2(m[2])), 1));
}

glm::dvec2 Camera::project(const glm::dvec3& viewPosition) const {
  const glm::dvec4 clip = clipFromView_ * glm::dvec4(viewPosition, 1);
  return {(clip.x / clip.w * 0.5 + 0.5) * width_, (clip.y / clip.w * 0.5 + 0.5) * height_};
}

}  // namespace pellucid::harness::reference
