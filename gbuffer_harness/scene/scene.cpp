#include "scene/scene.h"

#include "common/error.h"
#include "scene/model.h"
#include "scene/render.h"

namespace pellucid::harness {

namespace {

constexpr int kLargestSide = 8192;

const std::vector<SceneDefinition>& definitions() {
  static const std::vector<SceneDefinition> all = [] {
    std::vector<SceneDefinition> joined;
    for (auto list : {earScenes(), solidScenes(), patternScenes(), clutterScenes()}) {
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

Capture makeScene(const SceneParameters& parameters, Image* exactThickness) {
  const SceneDefinition& scene = findScene(parameters.name);
  checkSide("width", parameters.width, 1);
  checkSide("height", parameters.height, 1);
  checkSide("shadowSize", parameters.shadowSize, 0);
  if (parameters.depthEncoding == PELLUCID_DEPTH_DISTANCE) {
    throw InputError("", "depthEncoding", "distance is an encoding of shadow maps only");
  }
  const OptionValues options(scene.info, parameters.options);
  return renderCapture(scene.build(parameters, options), parameters, exactThickness);
}

}  // namespace pellucid::harness
