#include "raster/view_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scene/turn.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr double kSteepest = 89 * std::numbers::pi / 180;

glm::dmat4 worldFromView(const ViewCamera& camera) { return glm::inverse(toGlm(camera.lens.viewFromWorld)); }

Vector3 axis(const ViewCamera& camera, int column) {
  return fromGlm(glm::dvec3(worldFromView(camera)[column]));
}

// Turns the camera about its right axis through `center`, upwards; `elevation` is what it has by now.
void pitchAbout(ViewCamera& camera, const Vector3& center, double pitch, double elevation) {
  pitch = std::clamp(elevation + pitch, -kSteepest, kSteepest) - elevation;
  const glm::dvec3 right = toGlm(camera.right());
  glm::dmat4 turn = glm::translate(glm::dmat4(1), toGlm(center));
  turn = glm::rotate(turn, pitch, right);
  turn = glm::translate(turn, -toGlm(center));
  const glm::dmat4 world = turn * worldFromView(camera);
  // lookAt() keeps it rigid after any number of turns.
  const glm::dvec3 eye(world[3]);
  camera.lens.viewFromWorld =
      lookAt(fromGlm(eye), fromGlm(eye - glm::dvec3(world[2])), fromGlm(glm::dvec3(world[1])));
}

}  // namespace

Vector3 ViewCamera::eye() const { return axis(*this, 3); }
Vector3 ViewCamera::right() const { return axis(*this, 0); }
Vector3 ViewCamera::up() const { return axis(*this, 1); }
Vector3 ViewCamera::back() const { return axis(*this, 2); }

Vector3 turned(const Vector3& vector, const Vector3& axis, double angle) {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle, glm::normalize(toGlm(axis)));
  return fromGlm(glm::dvec3(turn * glm::dvec4(toGlm(vector), 0)));
}

void orbit(ViewCamera& camera, double yaw, double pitch) {
  camera.lens.viewFromWorld = turnedView(camera.lens.viewFromWorld, camera.pivot, yaw);
  // Upwards the camera turns against its own right axis.
  const double elevation = std::asin(std::clamp(camera.back()[1], -1.0, 1.0));
  pitchAbout(camera, camera.pivot, -pitch, -elevation);
}

void look(ViewCamera& camera, double yaw, double pitch) {
  const Vector3 eye = camera.eye();
  const double distance = glm::length(toGlm(camera.pivot) - toGlm(eye));
  camera.lens.viewFromWorld = turnedView(camera.lens.viewFromWorld, eye, yaw);
  pitchAbout(camera, eye, pitch, std::asin(std::clamp(-camera.back()[1], -1.0, 1.0)));
  camera.pivot = fromGlm(toGlm(eye) - distance * toGlm(camera.back()));
}

void walk(ViewCamera& camera, const Vector3& step) {
  const glm::dvec3 moved =
      step[0] * toGlm(camera.right()) + step[1] * toGlm(camera.up()) - step[2] * toGlm(camera.back());
  camera.lens.viewFromWorld =
      fromGlm(toGlm(camera.lens.viewFromWorld) * glm::translate(glm::dmat4(1), -moved));
  camera.pivot = fromGlm(toGlm(camera.pivot) + moved);
}

void zoom(ViewCamera& camera, double factor) {
  if (camera.lens.orthographic) {
    camera.lens.height *= factor;
    return;
  }
  const Vector3 pivot = camera.pivot;
  const double distance = glm::length(toGlm(pivot) - toGlm(camera.eye()));
  walk(camera, {0, 0, distance * (1 - factor)});
  camera.pivot = pivot;
}

void fitRange(ViewCamera& camera, const Vector3& center, double radius) {
  constexpr double kMargin = 1.02, kNearest = 1e-3;
  const glm::dvec4 seen = toGlm(camera.lens.viewFromWorld) * glm::dvec4(toGlm(center), 1);
  ClipRange& range = camera.lens.range;
  range.farPlane = -seen.z + kMargin * radius;
  range.nearPlane = -seen.z - kMargin * radius;
  if (camera.lens.orthographic) return;
  if (!(range.farPlane > 0)) range.farPlane = radius;  // all of it is behind the camera
  range.nearPlane = std::max(range.nearPlane, kNearest * range.farPlane);
}

}  // namespace pellucid::harness
