#include "raster/camera_path.h"

#include <glm/glm.hpp>
#include <numbers>

#include "raster/framing.h"
#include "scene/turn.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// A camera turned about its own upright axis.
Matrix panned(const Matrix& viewFromWorld, double angle) {
  return fromGlm(toGlm(turnedView(kIdentity, {0, 0, 0}, angle)) * toGlm(viewFromWorld));
}

// A camera moved away from `center` along the line to it, by a part of the distance.
Matrix movedAway(const Matrix& viewFromWorld, const Vector3& center, double part) {
  glm::dmat4 view = toGlm(viewFromWorld);
  const glm::dvec3 toCenter(view * glm::dvec4(toGlm(center), 1));
  view[3] += glm::dvec4(part * toCenter, 0);
  return fromGlm(view);
}

}  // namespace

CameraPath::CameraPath(const std::string& name, const Model& model, const ModelCamera& camera)
    : name_(name), still_{camera, model.lights, false}, center_(boundsOf(model).center) {
  // Whatever the camera does, the model stays between its planes.
  still_.camera.range.nearPlane *= 0.5;
  still_.camera.range.farPlane *= 2;
}

CameraPath::Pose CameraPath::at(int frame) const {
  const double angle = frame * kPathDegrees * std::numbers::pi / 180;
  Pose pose = still_;
  Matrix& view = pose.camera.viewFromWorld;
  if (name_ == "pan") view = panned(view, angle);
  if (name_ == "dolly") view = movedAway(view, center_, frame * kPathDolly);
  if (name_ == "orbit") view = turnedView(view, center_, angle);
  // A body that turns before a fixed camera is a camera and lights that turn by the opposite angle.
  if (name_ == "head") view = turnedView(view, center_, -angle);
  if (name_ == "head" || name_ == "lights")
    for (Light& light : pose.lights) light = turnedLight(light, center_, name_ == "head" ? -angle : angle);
  if (name_ == "blink") {
    if (frame / kBlinkFrames % 2 == 1) pose.lights.back().intensity = 0;
    pose.switches = frame > 0 && frame % kBlinkFrames == 0;
  }
  return pose;
}

}  // namespace pellucid::harness
