#include "cli/light_option.h"

#include <cmath>
#include <numbers>

#include "capture/manifest_parts.h"
#include "cli/numbers.h"
#include "raster/framing.h"

namespace pellucid::harness {

namespace {

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

double parseUnit(const std::string& text) {
  if (text == "mm") return 0.001;
  if (text == "cm") return 0.01;
  if (text == "m") return 1;
  const double meters = parseNumber<double>("--unit", text);
  if (!(meters >= 1e-9 && meters <= 1e9))
    throw UsageError("--unit: \"" + text + "\" is not a length from 1e-9 to 1e9 meters");
  return meters;
}

Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera) {
  Light light;
  if (text == kBackLight || text == kFrontLight) {
    // Columns of viewFromWorld's transpose are the view's axes in the world; +z is towards the camera.
    const Matrix& m = camera.viewFromWorld;
    const double sign = text == kBackLight ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i) light.direction[i] = sign * m[4 * i + 2] - 0.4 * m[4 * i + 1];
    return light;
  }
  std::vector<std::string> parts = split(text, ':');
  const bool sphere = parts[0] == "sphere" && parts.size() >= 3;
  if (sphere) {
    light.radius = parseNumber<double>("--light", parts[2]);
    if (!(light.radius > 0)) throw UsageError("--light: \"" + text + "\": the radius is not above 0");
    parts.erase(parts.begin() + 2);
  }
  const std::vector<std::string> numbers = split(parts.size() > 1 ? parts[1] : "", ',');
  const bool known = parts[0] == "directional" || parts[0] == "point" || parts[0] == "spot" || sphere;
  if (!known || parts.size() > 3 || numbers.size() != 3)
    throw UsageError("--light: \"" + text + "\" is not " + kLightSyntax);
  Vector3 where;
  for (std::size_t i = 0; i < 3; ++i) where[i] = parseNumber<double>("--light", numbers[i]);
  if (parts[0] == "directional") {
    light.direction = where;
  } else {
    for (std::size_t i = 0; i < 3; ++i) where[i] -= model.origin[i];
    const Bounds bounds = boundsOf(model);
    const double away = distance(where, bounds.center);
    light.type = parts[0] == "spot" ? PELLUCID_LIGHT_SPOT : PELLUCID_LIGHT_POINT;
    light.position = where;
    light.intensity = away * away;
    if (away == 0 && parts.size() < 3)
      throw UsageError("--light: \"" + text +
                       "\" stands at the center, where no intensity makes 1 arrive; add :I");
    if (light.radius > 0 && away < bounds.radius + light.radius)
      throw UsageError("--light: \"" + text + "\" reaches into the model's surroundings");
    if (light.type == PELLUCID_LIGHT_SPOT) {
      if (away == 0) throw UsageError("--light: \"" + text + "\" stands at the center it looks at");
      for (std::size_t i = 0; i < 3; ++i) light.direction[i] = (bounds.center[i] - where[i]) / away;
      light.outerConeAngle = bounds.radius < away ? std::asin(bounds.radius / away) : std::numbers::pi / 4;
      light.innerConeAngle = 0.8 * light.outerConeAngle;
    }
  }
  if (parts.size() == 3) light.intensity = parseNumber<double>("--light", parts[2]);
  fitLight(light, [&](const char* key, const std::string& sentence) {
    throw UsageError("--light: \"" + text + "\": " + key + " " + sentence);
  });
  return light;
}

}  // namespace pellucid::harness
