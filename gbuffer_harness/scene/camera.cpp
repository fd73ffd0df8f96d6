#include "scene/camera.h"

#include <cmath>
#include <numbers>

#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

void checkRange(const ClipRange& range) {
  if (!std::isfinite(range.nearPlane) || !(range.farPlane > range.nearPlane)) {
    throw InputError("", "projection",
                     "near " + std::to_string(range.nearPlane) + " must be finite and below far " +
                         std::to_string(range.farPlane));
  }
}

}  // namespace

Matrix perspective(double verticalFov, double aspect, const ClipRange& range) {
  checkRange(range);
  if (!(range.nearPlane > 0)) {
    throw InputError("", "projection",
                     "near " + std::to_string(range.nearPlane) + " of a perspective must be > 0");
  }
  if (!(verticalFov > 0 && verticalFov < std::numbers::pi) || !(aspect > 0)) {
    throw InputError("", "projection",
                     "field of view " + std::to_string(verticalFov) + " or aspect " + std::to_string(aspect) +
                         " is out of range");
  }
  const double n = range.nearPlane;
  const double f = range.farPlane;
  // Depth is (a z + b) / z in the planar distance z.
  double a;
  double b;
  if (std::isinf(f)) {
    a = range.reversed ? 0 : 1;
    b = range.reversed ? n : -n;
  } else {
    a = range.reversed ? -n / (f - n) : f / (f - n);
    b = range.reversed ? n * f / (f - n) : -n * f / (f - n);
  }
  const double scale = 1 / std::tan(verticalFov / 2);
  return {scale / aspect, 0, 0, 0, 0, -scale, 0, 0, 0, 0, -a, -1, 0, 0, b, 0};
}

Matrix orthographic(double width, double height, const ClipRange& range) {
  checkRange(range);
  if (std::isinf(range.farPlane)) {
    throw InputError("", "projection", "an orthographic projection needs a finite far plane");
  }
  if (!(width > 0) || !(height > 0)) {
    throw InputError(
        "", "projection",
        "width " + std::to_string(width) + " and height " + std::to_string(height) + " must be > 0");
  }
  const double span = range.farPlane - range.nearPlane;
  const double a = range.reversed ? -1 / span : 1 / span;
  const double b = range.reversed ? range.farPlane / span : -range.nearPlane / span;
  return {2 / width, 0, 0, 0, 0, -2 / height, 0, 0, 0, 0, -a, 0, 0, 0, b, 1};
}

Matrix lookAt(const Vector3& eye, const Vector3& target, const Vector3& up) {
  const glm::dvec3 position = toGlm(eye);
  const glm::dvec3 axis = glm::normalize(toGlm(target) - position);
  glm::dvec3 upward = toGlm(up);
  if (glm::length(glm::cross(axis, upward)) < 1e-6 * glm::length(upward)) {
    upward = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
  }
  const glm::dvec3 right = glm::normalize(glm::cross(axis, upward));
  const glm::dvec3 top = glm::cross(right, axis);
  const glm::dvec3 depth = -axis;
  glm::dmat4 viewFromWorld(glm::transpose(glm::dmat3(right, top, depth)));
  viewFromWorld[3] =
      glm::dvec4(-glm::dot(right, position), -glm::dot(top, position), -glm::dot(depth, position), 1);
  return fromGlm(viewFromWorld);
}

double deviceDepth(const Matrix& clipFromView, double viewZ) {
  return (clipFromView[10] * -viewZ + clipFromView[14]) / (clipFromView[11] * -viewZ + clipFromView[15]);
}

double clearDepth(const Matrix& clipFromView) {
  // Depth is monotonic in front of the eye, so two distances tell the direction.
  return deviceDepth(clipFromView, 2) > deviceDepth(clipFromView, 1) ? 1 : 0;
}

Matrix multiply(const Matrix& a, const Matrix& b) { return fromGlm(toGlm(a) * toGlm(b)); }

}  // namespace pellucid::harness
