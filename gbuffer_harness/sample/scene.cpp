#include "sample/scene.h"

#include <cmath>

#include "capture/material.h"
#include "raster/mesh.h"
#include "scene/environment.h"
#include "scene/vector.h"

namespace pellucid::sample {

namespace {

// In the direction `toLight`, `distance` radii from the center, where the light gives irradiance E.
void addLight(Scene& scene, int mapTexels, PellucidLightType type, const glm::dvec3& toLight, double distance,
              double irradiance, const std::array<double, 3>& color) {
  const double away = distance * scene.bounds.radius;
  const glm::dvec3 axis = glm::normalize(toLight);
  auto& [light, views] = scene.lights.emplace_back();
  light.type = type;
  light.position = fromGlm(toGlm(scene.bounds.center) + away * axis);
  light.direction = fromGlm(-axis);
  light.color = color;
  light.intensity = type == PELLUCID_LIGHT_DIRECTIONAL ? irradiance : irradiance * away * away;
  light.outerConeAngle = std::asin(std::min(1.1 / distance, 0.9));
  light.innerConeAngle = 0.8 * light.outerConeAngle;
  if (type != PELLUCID_LIGHT_DIRECTIONAL) views = frameLight(scene.model, light, PointMaps::Six, mapTexels);
}

// A model's scene: the camera around all of it, and the same lights for every model, two of them in front.
Scene sceneOf(Model model, const Vector3& toCamera, int mapTexels) {
  constexpr double kFov = 0.5;  // radians
  Scene scene;
  scene.model = std::move(model);
  scene.bounds = boundsOf(scene.model);
  scene.camera.lens = frameModel(scene.model, toCamera, kFov, 1, false);
  scene.camera.pivot = scene.bounds.center;
  addLight(scene, mapTexels, PELLUCID_LIGHT_DIRECTIONAL, {-0.55, 0.35, -0.75}, 4, 3, {1, 0.93, 0.8});
  addLight(scene, mapTexels, PELLUCID_LIGHT_SPOT, {0.6, 0.5, 0.7}, 3, 1, {1, 0.96, 0.9});
  addLight(scene, mapTexels, PELLUCID_LIGHT_SPOT, {-0.9, 0.1, 0.5}, 3, 0.5, {0.7, 0.8, 1});
  addLight(scene, mapTexels, PELLUCID_LIGHT_SPOT, {0.45, 0.2, -1}, 3, 5, {1, 0.85, 0.7});
  addLight(scene, mapTexels, PELLUCID_LIGHT_POINT, {1, -0.1, -0.25}, 1.1, 1.2, {1, 0.6, 0.35});
  scene.ambient = Environment{{0.1, 0.13, 0.18}, {0.04, 0.035, 0.03}}.harmonics();
  Capture materials;
  materials.name = scene.model.name;
  materials.materials = scene.model.materials;
  scene.materials = compileMaterials(materials);
  return scene;
}

}  // namespace

Scene headScene(double cell, int mapTexels) {
  SceneParameters head;
  head.name = "head";
  Scene scene = sceneOf(meshOf(sceneModel(head), "head", cell), {0.35, 0.12, 1}, mapTexels);
  Model& model = scene.model;  // shadow maps leave the floor out, which casts none
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  const auto half = static_cast<float>(20 * scene.bounds.radius),
             y = static_cast<float>(scene.bounds.center[1] - 0.66 * scene.bounds.radius);
  for (const auto& [x, z] : {std::pair(-half, half), {half, half}, {half, -half}, {-half, -half}})
    model.vertices.push_back({{x, y, z}, {0, 1, 0}});
  model.parts.push_back({static_cast<std::uint32_t>(model.indices.size()), 6, 1, 1});
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) model.indices.push_back(first + i);
  model.surfaces.push_back({"floor", {0.12, 0.12, 0.13}});
  return scene;
}

}  // namespace pellucid::sample
