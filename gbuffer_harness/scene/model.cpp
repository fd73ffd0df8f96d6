#include "scene/model.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness {

Ray Camera::ray(double x, double y, int width, int height) const {
  const double ndcX = 2 * x / width - 1;
  const double ndcY = 2 * y / height - 1;
  glm::dvec3 origin(0), direction(0, 0, -1);
  if (orthographic) {
    origin = {(ndcX - clipFromView[12]) / clipFromView[0], (ndcY - clipFromView[13]) / clipFromView[5], 0};
    direction = {clipFromView[8] / clipFromView[0], clipFromView[9] / clipFromView[5], -1};  // sheared: not 0
  } else {
    direction = {(ndcX + clipFromView[8]) / clipFromView[0], (ndcY + clipFromView[9]) / clipFromView[5], -1};
  }
  // viewFromWorld is rigid, so its inverse is the transpose and -R^T t.
  const glm::dmat4 view = toGlm(viewFromWorld);
  const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(view));
  return {worldFromView * (origin - glm::dvec3(view[3])), glm::normalize(worldFromView * direction)};
}

double Camera::viewZPerLength(const Ray& ray) const {
  return -(viewFromWorld[2] * ray.direction.x + viewFromWorld[6] * ray.direction.y +
           viewFromWorld[10] * ray.direction.z);
}

OptionValues::OptionValues(const SceneInfo& info, const std::map<std::string, double>& given) {
  for (const SceneOption& option : info.options) values_[option.name] = option.defaultValue;
  for (const auto& [name, value] : given) {
    const SceneOption* known = nullptr;
    std::string names;
    for (const SceneOption& option : info.options) {
      if (option.name == name) known = &option;
      names += (names.empty() ? "" : ", ") + option.name;
    }
    if (!known) {
      throw InputError("", "scene \"" + info.name + "\"",
                       "no option \"" + name + "\"; it has " + (names.empty() ? "none" : names));
    }
    if (!(value >= known->minimum && value <= known->maximum)) {
      std::ostringstream sentence;
      sentence << "option " << name << " = " << value << " is outside " << known->minimum << " .. "
               << known->maximum;
      throw InputError("", "scene \"" + info.name + "\"", sentence.str());
    }
    values_[name] = value;
  }
}

Camera placeCamera(const SceneParameters& parameters, const CameraPlacement& placement) {
  Camera camera;
  camera.orthographic = parameters.orthographic.value_or(placement.orthographic);
  camera.range = {placement.nearPlane, placement.farPlane, parameters.reversedZ};
  if (parameters.infiniteFar) {
    if (camera.orthographic) {
      throw InputError("", "infiniteFar", "an orthographic projection needs a finite far plane");
    }
    camera.range.farPlane = std::numeric_limits<double>::infinity();
  }
  const double aspect = static_cast<double>(parameters.width) / parameters.height;
  const double height = placement.extent / aspect;
  const double distance = glm::distance(placement.eye, placement.target);
  camera.clipFromView = camera.orthographic
                            ? harness::orthographic(placement.extent, height, camera.range)
                            : perspective(2 * std::atan(height / 2 / distance), aspect, camera.range);
  camera.viewFromWorld = lookAt(fromGlm(placement.eye), fromGlm(placement.target), {0, 1, 0});
  return camera;
}

Light placeLight(const SceneParameters& parameters, const LightPlacement& placement) {
  const glm::dvec3 toward = glm::normalize(placement.towardLight);
  Light light;
  light.type = parameters.lightType.value_or(placement.type);
  light.direction = fromGlm(-toward);
  light.position = fromGlm(placement.target + placement.distance * toward);
  light.color = fromGlm(placement.color);
  light.intensity = placement.irradiance;
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL) light.intensity *= placement.distance * placement.distance;
  if (light.type == PELLUCID_LIGHT_SPOT) {
    light.outerConeAngle = std::atan(placement.coneRadius / placement.distance);
    light.innerConeAngle = 0.8 * light.outerConeAngle;
  }
  return light;
}

Camera frontCamera(const SceneParameters& parameters, double extent) {
  return placeCamera(parameters, {{0, 0, 4 * extent}, {0, 0, 0}, extent, false, extent / 4, 12 * extent});
}

Light lightAt(const SceneParameters& parameters, const glm::dvec3& toward, double irradiance, double extent) {
  LightPlacement light{glm::dvec3(0), toward, irradiance};
  light.distance = 5 * extent;
  light.coneRadius = extent;
  return placeLight(parameters, light);
}

}  // namespace pellucid::harness
