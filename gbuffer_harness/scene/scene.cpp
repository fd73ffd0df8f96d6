#include "scene/scene.h"

#include "common/error.h"
#include "scene/model.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr int kLargestSide = 8192;

const std::vector<SceneDefinition>& definitions() {
  static const std::vector<SceneDefinition> all = [] {
    std::vector<SceneDefinition> joined;
    for (auto list : {earScenes(), headScenes(), solidScenes(), patternScenes(), clutterScenes()}) {
      joined.insert(joined.end(), list.begin(), list.end());
    }
    return joined;
  }();
  return all;
}

void checkSide(const char* field, int value, int smallest) {
  if (value < smallest || value > kLargestSide) {
    throw InputError("", field,
                     std::to_string(value) + " is outside " + std::to_string(smallest) + " .. " +
                         std::to_string(kLargestSide));
  }
}

[[noreturn]] void refuse(const SceneParameters& parameters, const char* why) {
  throw InputError("", "scene \"" + parameters.name + "\"", why);
}

void applyTurn(const SceneParameters& parameters, SceneModel& model) {
  const Vector3 center = fromGlm(model.center);
  if (const auto angle = parameters.turn.camera) {
    if (model.endless) refuse(parameters, "has no end, so that a camera cannot go round it");
    model.camera.viewFromWorld = turnedView(model.camera.viewFromWorld, center, *angle);
  }
  if (const auto angle = parameters.turn.lights) {
    if (model.lights.empty()) refuse(parameters, "has painted irradiance and no lights that could turn");
    for (Light& light : model.lights) light = turnedLight(light, center, *angle);
  }
}

}  // namespace

std::vector<SceneInfo> listScenes() {
  std::vector<SceneInfo> list;
  for (const SceneDefinition& definition : definitions()) list.push_back(definition.info);
  return list;
}

const SceneDefinition& findScene(const std::string& name) {
  std::string names;
  for (const SceneDefinition& definition : definitions()) {
    if (definition.info.name == name) return definition;
    names += (names.empty() ? "" : ", ") + definition.info.name;
  }
  throw InputError("", "scene", "no scene \"" + name + "\"; there are " + names);
}

SceneModel sceneModel(const SceneParameters& parameters) {
  const SceneDefinition& scene = findScene(parameters.name);
  checkSide("width", parameters.width, 1);
  checkSide("height", parameters.height, 1);
  checkSide("shadowSize", parameters.shadowSize, 0);
  if (parameters.depthEncoding == PELLUCID_DEPTH_DISTANCE) {
    throw InputError("", "depthEncoding", "distance is an encoding of shadow maps only");
  }
  SceneModel model = scene.build(parameters, OptionValues(scene.info, parameters.options));
  if (const auto& material = parameters.material) {
    model.materials.assign(model.materials.size(), material->source);
    model.albedo = [albedo = toGlm(material->albedo)](const glm::dvec3&) { return albedo; };
  }
  applyTurn(parameters, model);
  return model;
}

Capture makeScene(const SceneParameters& parameters) {
  return renderCapture(sceneModel(parameters), parameters);
}

Vector3 sceneCenter(const SceneParameters& parameters) {
  const SceneDefinition& scene = findScene(parameters.name);
  return fromGlm(scene.build(parameters, OptionValues(scene.info, parameters.options)).center);
}

}  // namespace pellucid::harness
