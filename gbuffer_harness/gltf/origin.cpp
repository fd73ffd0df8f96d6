#include "gltf/origin.h"

#include <algorithm>
#include <cstdio>
#include <glm/glm.hpp>
#include <limits>

#include "common/far_origin.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// A place around which the scene has to be drawn finely, and the distance from the place that counts.
struct Anchor {
  glm::dvec3 position;
  double distance;
};

Anchor anchorOf(const Model& model, const std::vector<glm::dvec3>& positions, const std::string& camera) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::uint32_t i : model.indices) {
    low = glm::min(low, positions[i]);
    high = glm::max(high, positions[i]);
  }
  const Anchor center{0.5 * (low + high), 0.5 * glm::length(high - low)};
  const auto found = std::find_if(model.cameras.begin(), model.cameras.end(),
                                  [&](const ModelCamera& c) { return camera.empty() || c.name == camera; });
  if (found == model.cameras.end()) return center;
  const glm::dvec3 eye = glm::inverse(toGlm(found->viewFromWorld))[3];
  // An orthographic camera's near plane may lie at its eye.
  const double seen = found->orthographic ? found->height : kNearPlanes * found->range.nearPlane;
  return {eye, std::min(center.distance, seen)};
}

}  // namespace

bool moveOrigin(Model& model, const std::vector<glm::dvec3>& positions, const std::string& camera) {
  const Anchor anchor = anchorOf(model, positions, camera);
  glm::dvec3 origin(0);
  if (glm::length(anchor.position) > kFarthest * anchor.distance && anchor.distance > 0)
    origin = toGlm(originNear(fromGlm(anchor.position), anchor.distance));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3 p(positions[i] - origin);
    model.vertices[i].position = {p.x, p.y, p.z};
  }
  if (origin == glm::dvec3(0)) return false;
  model.origin = fromGlm(origin);
  for (ModelCamera& c : model.cameras) c.viewFromWorld = fromOrigin(c.viewFromWorld, model.origin);
  for (Light& light : model.lights) light.position = fromGlm(toGlm(light.position) - origin);
  return true;
}

std::string originNote(const Model& model) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the scene is far from its origin: the capture's world begins at %.9g, %.9g, %.9g",
                model.origin[0], model.origin[1], model.origin[2]);
  return text;
}

}  // namespace pellucid::harness
