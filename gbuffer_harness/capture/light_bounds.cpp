#include "capture/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "common/bounds.h"

namespace pellucid::harness {
namespace {

constexpr double kMost = 1e15;  // of the module's lengths and intensities

std::string shown(double value) {
  std::ostringstream number;
  number.precision(9);  // as many as tell two floats apart
  number << value;
  return number.str();
}

}  // namespace

void fitLight(Light& light, const std::function<void(const char* key, const std::string& sentence)>& fail) {
  const auto fit = [&](const char* key, double& value, double most) {
    value = fitted(value, 0, most);
    if (!(value >= 0)) fail(key, "must not be negative, is " + shown(value));
    if (!(value <= most)) fail(key, "must be at most " + shown(most) + ", is " + shown(value));
  };
  for (double& component : light.color) fit("color", component, kMost);
  fit("intensity", light.intensity, kMost);
  light.range = std::min(light.range, kMost);  // exporters write up to FLT_MAX for unlimited lights
  fit("range", light.range, kMost);
  fit("radius", light.radius, kMost);
  if (light.radius > 0 && light.type != PELLUCID_LIGHT_POINT)
    fail("radius", "only a point light has one, is " + shown(light.radius));
  if ((light.type != PELLUCID_LIGHT_POINT || !light.angleTable.empty()) &&
      !(std::hypot(light.direction[0], light.direction[1], light.direction[2]) > 0))
    fail("direction", "must have a length above 0");
  if (light.type != PELLUCID_LIGHT_SPOT) return;
  double &inner = light.innerConeAngle, &outer = light.outerConeAngle;
  outer = fitted(outer, 0, std::numbers::pi / 2);
  if (!(outer > roundingAt(0) && outer <= std::numbers::pi / 2))
    fail("outerConeAngle", "must be above 0 and at most pi/2 radians, is " + shown(outer));
  // The bound is below the outer angle by what floats can tell apart.
  inner = fitted(inner, 0, outer);
  if (!(inner >= 0 && inner <= outer))
    fail("innerConeAngle",
         "must be at least 0 and less than outerConeAngle, " + shown(outer) + ", is " + shown(inner));
  inner = std::min(inner, outer - roundingAt(outer));
}

}  // namespace pellucid::harness
