#include "cull.h"

#include <algorithm>
#include <cmath>

#include "lights.h"

namespace pellucid {
namespace {

// Radians, and of lengths relative to the light's distance: a thousand times what float positions and
// directions are off by in the shaders, and nothing that a picture shows.
constexpr double kMargin = 1e-4;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
}

}  // namespace

ViewBounds::ViewBounds(const Setup& setup) : setup_(setup) {
  const DepthRange& range = setup.depthRange;
  const shared::Camera& camera = setup.camera;
  parallel_ = !range.perspective;
  bounded_ = parallel_ || range.d == 0;
  forward_ = range.forward;

  // The image's corners, half a pixel outside of the centers that the shaders use. The rect's own would drop more lights, but the
  // caller's images serve every rect, so that no rect may change which images there are.
  const double left = setup.lattice.first.x - 0.5, top = setup.lattice.first.y - 0.5;
  const double right = left + setup.frame.imageExtent[0], bottom = top + setup.frame.imageExtent[1];
  const glm::dvec2 corners[4] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
  std::array<glm::dvec3, 4> directions;
  axis_ = glm::dvec3(0);
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec4 ray = glm::dvec4(camera.rayBase) + corners[i].x * glm::dvec4(camera.rayX) +
                           corners[i].y * glm::dvec4(camera.rayY);
    starts_[i] = {ray.z, ray.w, 0};
    directions[i] = {ray.x, ray.y, forward_};
    axis_ += glm::normalize(directions[i]);
  }
  halfAngle_ = 0;
  for (const glm::dvec3& d : directions) halfAngle_ = std::max(halfAngle_, angleBetween(axis_, d));
  // A cone is convex, and so holds what lies between the corners, up to a right angle.
  if (!(halfAngle_ < 1.57)) halfAngle_ = INFINITY;
  if (setup.thesis.constantViewDirection) {
    axis_ = {0, 0, forward_};
    halfAngle_ = 0;
  }

  glm::dvec3 middle(0);
  for (size_t i = 0; i < 4; ++i) middle += 0.25 * (starts_[i] + directions[i]);
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 at = starts_[i] + directions[i], next = starts_[(i + 1) % 4] + directions[(i + 1) % 4];
    glm::dvec3 normal = glm::normalize(glm::cross(directions[i], next - at));
    if (glm::dot(normal, middle - at) < 0) normal = -normal;
    planes_[i] = {normal, glm::dot(normal, at)};
  }
  planes_[4] = {{0, 0, forward_}, 0};
}

// Every factor but NORMAL's needs the cosine between the view ray and the direction to the light to be above
// -minimumDot (0 for models without). Walking along a ray turns a light from ahead to behind, so for a
// light at a point that cosine is largest where the ray starts.
bool ViewBounds::angleStops(const PellucidLight& light) const {
  const PellucidThesisOptions& thesis = setup_.thesis;
  if (thesis.angleModel == PELLUCID_ANGLE_NORMAL) return false;
  const double least = -setup_.minimumDot(light);
  if (least >= 1) return true;
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) {
    const glm::dvec3 toLight = -(glm::dmat3(setup_.viewFromWorld) * toVector(light.direction));
    return angleBetween(axis_, toLight) - halfAngle_ > std::acos(least) + kMargin;
  }
  const glm::dvec3 position(setup_.viewFromWorld * glm::dvec4(toVector(light.position), 1));
  if (thesis.constantViewDirection || parallel_) {
    const glm::dvec3 direction = glm::normalize(axis_);
    return std::all_of(starts_.begin(), starts_.end(), [&](const glm::dvec3& start) {
      return glm::dot(direction, position - start) < -kMargin * glm::length(position - start);
    });
  }
  return angleBetween(axis_, position - starts_[0]) - halfAngle_ > std::acos(least) + kMargin;
}

bool ViewBounds::rangeMisses(const PellucidLight& light) const {
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL || !(light.range > 0)) return false;
  const glm::dvec3 position(setup_.viewFromWorld * glm::dvec4(toVector(light.position), 1));
  const double reach = light.range + kMargin * (light.range + glm::length(position));
  return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return glm::dot(plane.normal, position) - plane.offset < -reach;
  });
}

// A cone whose tip is outside of a plane and none of whose rays turns towards the inside.
bool ViewBounds::coneMisses(const PellucidLight& light) const {
  if (light.type != PELLUCID_LIGHT_SPOT) return false;
  const glm::dvec3 position(setup_.viewFromWorld * glm::dvec4(toVector(light.position), 1));
  const glm::dvec3 direction = glm::dmat3(setup_.viewFromWorld) * toVector(light.direction);
  const double right = std::acos(0.0);
  return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    return glm::dot(plane.normal, position) - plane.offset < -kMargin * glm::length(position) &&
           angleBetween(direction, plane.normal) - light.outerConeAngle > right + kMargin;
  });
}

const char* ViewBounds::whySkipped(const PellucidLight& light) const {
  if (light.intensity <= 0 || (light.color[0] <= 0 && light.color[1] <= 0 && light.color[2] <= 0))
    return "no intensity";
  if (setup_.lacksChord(light) && !setup_.thinWalls)
    return setup_.holdsBackFaces(light)
               ? "no back depth to take a thickness from, and its map holds back faces"
               : "no back depth to take a thickness from";
  // Gathered and ambient light come from around, whatever the angle, and from beyond the view.
  if (setup_.isGathered(light) || isAmbient(light)) return nullptr;
  // That view shows thicknesses whether light comes through or not.
  if (!bounded_ || setup_.frame.options.debugView == PELLUCID_DEBUG_THICKNESS) return nullptr;
  if (angleStops(light)) return "no pixel's view ray passes its angle test";
  if (rangeMisses(light)) return "its range does not reach the view";
  if (coneMisses(light)) return "its cone points away from the view";
  return nullptr;
}

}  // namespace pellucid
