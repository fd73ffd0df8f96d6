#include "cli/flicker_path.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <numbers>

#include "cli/scene_capture.h"
#include "common/error.h"
#include "common/progress.h"
#include "raster/framing.h"
#include "scene/turn.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr std::array kPaths = {"pan", "dolly", "orbit", "head", "lights", "blink"};

struct Pose {
  ModelCamera camera;
  std::vector<Light> lights;
};

// The still pose's camera turned about its own upright axis.
Matrix panned(const Matrix& viewFromWorld, double angle) {
  const glm::dmat4 rotation = toGlm(turnedView(kIdentity, {0, 0, 0}, angle));
  return fromGlm(rotation * toGlm(viewFromWorld));
}

// The view moved away from `center` along the line to it, by a part of the distance.
Matrix movedAway(const Matrix& viewFromWorld, const Vector3& center, double part) {
  glm::dmat4 view = toGlm(viewFromWorld);
  const glm::dvec3 toCenter(view * glm::dvec4(toGlm(center), 1));
  view[3] += glm::dvec4(part * toCenter, 0);
  return fromGlm(view);
}

Pose poseAt(const std::string& path, const Pose& still, const Vector3& center, int frame) {
  const double angle = frame * kPathDegrees * std::numbers::pi / 180;
  Pose pose = still;
  Matrix& view = pose.camera.viewFromWorld;
  if (path == "pan") view = panned(view, angle);
  if (path == "dolly") view = movedAway(view, center, frame * kPathDolly);
  if (path == "orbit") view = turnedView(view, center, angle);
  // A body that turns before a fixed camera is a camera and lights that turn by the opposite angle.
  if (path == "head") view = turnedView(view, center, -angle);
  if (path == "head" || path == "lights")
    for (Light& light : pose.lights) light = turnedLight(light, center, path == "head" ? -angle : angle);
  if (path == "blink" && frame / kBlinkFrames % 2 == 1) pose.lights.back().intensity = 0;
  return pose;
}

}  // namespace

std::vector<PathStep> followPath(const std::string& path, int frames, const CaptureModel& scene,
                                 const std::optional<Environment>& sky, Device& device,
                                 const std::function<Image(const Capture&)>& replay) {
  if (std::find(kPaths.begin(), kPaths.end(), path) == kPaths.end())
    throw UsageError("--path: \"" + path + "\" is not " + kPathSyntax);
  if (scene.model.lights.empty() && (path == "lights" || path == "blink"))
    throw UsageError("--path " + path + ": the scene has no lights");
  CaptureModel moving = scene;
  Pose still{scene.camera, scene.model.lights};
  // Whatever the camera does, the model stays between its planes.
  still.camera.range.nearPlane *= 0.5;
  still.camera.range.farPlane *= 2;
  const Vector3 center = boundsOf(scene.model).center;
  std::vector<PathStep> steps;
  std::optional<Capture> before;
  Image beforeImage;
  Progress progress("path " + path, static_cast<std::size_t>(frames));
  for (int frame = 0; frame < frames; ++frame) {
    const Pose pose = poseAt(path, still, center, frame);
    moving.model.lights = pose.lights;
    Capture capture = captureScene(device, moving.model, pose.camera, moving.raster, sky).capture;
    if (before) capture.motion = motionSince(*before, capture);
    Image image = replay(capture);
    const bool switches = path == "blink" && frame % kBlinkFrames == 0;
    if (before && !switches)
      steps.push_back({compareAlongPath({*before, beforeImage}, {capture, image}),
                       compareAlongPath({*before, before->irradiance}, {capture, capture.irradiance})});
    before = std::move(capture);
    beforeImage = std::move(image);
    progress.advance();
  }
  return steps;
}

}  // namespace pellucid::harness
