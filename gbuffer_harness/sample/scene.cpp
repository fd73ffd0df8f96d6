#include "sample/scene.h"

#include <cmath>
#include <numbers>

#include "capture/material.h"
#include "gltf/gltf.h"
#include "raster/field_mesh.h"
#include "scene/environment.h"
#include "scene/model.h"
#include "scene/vector.h"

namespace pellucid::sample {

namespace {

constexpr double kFov = 0.5;  // radians

// A light in the direction `toLight`, `distance` radii from the center, where it gives irradiance E.
SceneLight placed(const Scene& scene, int mapTexels, PellucidLightType type, const glm::dvec3& toLight,
                  double distance, double irradiance, const std::array<double, 3>& color) {
  const double away = distance * scene.bounds.radius;
  const glm::dvec3 center = toGlm(scene.bounds.center), axis = glm::normalize(toLight);
  SceneLight result;
  Light& light = result.light;
  light.type = type;
  light.position = fromGlm(center + away * axis);
  light.direction = fromGlm(-axis);
  light.color = color;
  light.intensity = type == PELLUCID_LIGHT_DIRECTIONAL ? irradiance : irradiance * away * away;
  light.outerConeAngle = std::asin(std::min(1.1 / distance, 0.9));
  light.innerConeAngle = 0.8 * light.outerConeAngle;
  if (type != PELLUCID_LIGHT_DIRECTIONAL)
    result.views = frameLight(scene.model, light, PointMaps::Six, mapTexels);
  return result;
}

// The same lights for every model: a key and a fill in front, three behind it that come through.
void addLights(Scene& scene, int mapTexels) {
  scene.sun =
      placed(scene, mapTexels, PELLUCID_LIGHT_DIRECTIONAL, {-0.55, 0.35, -0.75}, 4, 3, {1, 0.93, 0.8});
  scene.spots = {placed(scene, mapTexels, PELLUCID_LIGHT_SPOT, {0.6, 0.5, 0.7}, 3, 1, {1, 0.96, 0.9}),
                 placed(scene, mapTexels, PELLUCID_LIGHT_SPOT, {-0.9, 0.1, 0.5}, 3, 0.5, {0.7, 0.8, 1}),
                 placed(scene, mapTexels, PELLUCID_LIGHT_SPOT, {0.45, 0.2, -1}, 3, 5, {1, 0.85, 0.7})};
  scene.point = placed(scene, mapTexels, PELLUCID_LIGHT_POINT, {1, -0.1, -0.25}, 1.1, 1.2, {1, 0.6, 0.35});
  scene.ambient = Environment{{0.1, 0.13, 0.18}, {0.04, 0.035, 0.03}}.harmonics();
}

void compile(Scene& scene) {
  for (std::size_t i = 0; i < scene.model.materials.size(); ++i)
    scene.materials.push_back(compileMaterial(scene.model.materials[i],
                                              scene.model.name + ": materials[" + std::to_string(i) + "]"));
}

}  // namespace

Scene fileScene(const std::filesystem::path& file, const std::map<std::string, std::string>& presets,
                int mapTexels) {
  GltfOptions options;
  options.presets = presets;
  GltfScene loaded = loadGltf(file, options);
  Scene scene;
  scene.model = std::move(loaded.model);
  scene.notes = std::move(loaded.notes);
  for (std::string& warning : loaded.warnings) scene.notes.push_back(std::move(warning));
  if (scene.model.materials.empty())
    throw InputError(file.string(), "materials", "none scatters light; --material NAME=PRESET gives one");
  scene.bounds = boundsOf(scene.model);
  scene.camera.lens = scene.model.cameras.empty() ? frameModel(scene.model, {0.35, 0.05, 1}, kFov, 1, false)
                                                  : scene.model.cameras.front();
  if (scene.camera.lens.orthographic)
    throw InputError(file.string(), "camera", "is orthographic; the sample draws perspectives");
  scene.camera.pivot = scene.bounds.center;
  for (const Surface& surface : scene.model.surfaces)
    if (surface.normalMap >= 0) {
      std::size_t bare = 0;
      for (const Vertex& vertex : scene.model.vertices) bare += vertex.tangent == std::array<float, 4>{};
      if (bare > 0)
        scene.notes.push_back(std::to_string(bare) +
                              " vertices have no tangent: their normal map is not used");
      break;
    }
  addLights(scene, mapTexels);
  compile(scene);
  return scene;
}

Scene headScene(double cell, int mapTexels) {
  SceneParameters parameters;
  parameters.name = "head";
  const SceneModel head = sceneModel(parameters);
  const auto& field = dynamic_cast<const DistanceField&>(*head.objects.front().solid);
  Scene scene;
  Model& model = scene.model;
  model.name = "head";
  model.metersPerUnit = 0.001;
  model.materials = head.materials;
  addMesh(field, fromGlm(head.center), head.radius, cell, model);
  model.surfaces = {{"skin"}, {"floor"}};
  model.surfaces[0].baseColor = fromGlm(head.albedo({}));
  model.surfaces[0].material = 1;
  model.surfaces[1].baseColor = {0.12, 0.12, 0.13};
  model.parts = {{0, static_cast<std::uint32_t>(model.indices.size()), 0, 0}};
  scene.bounds = boundsOf(model);
  scene.camera.lens = frameModel(model, {0.35, 0.12, 1}, kFov, 1, false);
  scene.camera.pivot = scene.bounds.center;
  addLights(scene, mapTexels);  // their maps leave the floor out, which casts no shadow
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  const auto half = static_cast<float>(20 * scene.bounds.radius),
             y = static_cast<float>(scene.bounds.center[1] - 0.66 * scene.bounds.radius);
  for (const auto& [x, z] : {std::pair(-half, half), {half, half}, {half, -half}, {-half, -half}})
    model.vertices.push_back({{x, y, z}, {0, 1, 0}});
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) model.indices.push_back(first + i);
  model.parts.push_back({model.parts[0].indexCount, 6, 1, 1});
  compile(scene);
  return scene;
}

}  // namespace pellucid::sample
