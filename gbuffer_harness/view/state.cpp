#include "view/state.h"

#include <algorithm>
#include <cmath>

#include "scene/turn.h"
#include "scene/vector.h"

namespace pellucid::harness {

ReplaySettings settingsFor(const ViewState& state, Shown shown) {
  ReplaySettings settings = state.settings;
  if (shown == Shown::Through) settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  if (shown != Shown::Debug) settings.debugView = PELLUCID_DEBUG_NONE;
  if (shown == Shown::Debug && settings.debugView == PELLUCID_DEBUG_NONE)
    settings.debugView = PELLUCID_DEBUG_THICKNESS;
  // As an engine passes the place of the body. Kept light stays with the screen.
  if (settings.anchor[3] == 0 && settings.reuse == PELLUCID_REUSE_NONE)
    settings.anchor = {static_cast<float>(state.center[0]), static_cast<float>(state.center[1]),
                       static_cast<float>(state.center[2]), 1};
  settings.aliasOutput = false;  // before and after are looked at together
  return settings;
}

bool isFalseColor(Shown shown) {
  return shown == Shown::Debug || shown == Shown::FrontDepth || shown == Shown::Material;
}

const std::vector<std::string>& shownNames() {
  static const std::vector<std::string> names = {"after", "before",      "through", "difference", "truth",
                                                 "debug", "front depth", "albedo",  "material"};
  return names;
}

ViewLight newLight(PellucidLightType type, const ViewCamera& camera, const Vector3& center, double radius) {
  const glm::dvec3 away = glm::normalize(0.4 * toGlm(camera.up()) - toGlm(camera.back()));
  ViewLight result;
  Light& light = result.light;
  light.type = type;
  light.direction = fromGlm(-away);
  if (type == PELLUCID_LIGHT_DIRECTIONAL) return result;
  const double distance = 3 * radius;
  light.position = fromGlm(toGlm(center) + distance * away);
  light.intensity = distance * distance;
  light.outerConeAngle = std::asin(1.0 / 3);  // the sphere of the radius
  light.innerConeAngle = 0.8 * light.outerConeAngle;
  return result;
}

void dragLight(Light& light, const ViewCamera& camera, const Vector3& center, double right, double up) {
  // Behind the center the same turn moves it the other way on the screen.
  const glm::dvec3 from = light.type == PELLUCID_LIGHT_DIRECTIONAL ? -toGlm(light.direction)
                                                                   : toGlm(light.position) - toGlm(center);
  const double side = glm::dot(from, toGlm(camera.back())) < 0 ? -1 : 1;
  const auto carried = [&](const Vector3& v) {
    return turned(turned(v, camera.up(), side * right), camera.right(), -side * up);
  };
  light.direction = carried(light.direction);
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL)
    light.position = fromGlm(toGlm(center) + toGlm(carried(fromGlm(toGlm(light.position) - toGlm(center)))));
}

void pullLight(Light& light, const Vector3& center, double factor) {
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) return;
  light.position = fromGlm(toGlm(center) + factor * (toGlm(light.position) - toGlm(center)));
  light.intensity *= factor * factor;
}

}  // namespace pellucid::harness
