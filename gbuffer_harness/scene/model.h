// What a procedural scene consists of before it is cast into images. Right-handed world, mm.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/solid.h"

namespace pellucid::harness {

struct Camera {
  Matrix clipFromView = kIdentity, viewFromWorld = kIdentity;
  ClipRange range;
  bool orthographic = false;

  // The view ray through image position (x, y) in pixels, (0, 0) the top left corner. It begins at
  // the eye, or for an orthographic camera on the plane of viewZ 0.
  Ray ray(double x, double y, int width, int height) const;
  // Planar distance per unit length of a ray of this camera.
  double viewZPerLength(const Ray& ray) const;
};

struct Object {
  std::unique_ptr<Solid> solid;
  std::uint8_t material = 1;
  std::function<std::uint8_t(const glm::dvec3&)> materialAt;  // by surface position; replaces material
};

struct SceneModel {
  Camera camera;
  std::vector<Object> objects;
  std::vector<Light> lights;  // without their shadow maps
  // The sphere that shadow maps cover.
  glm::dvec3 center = glm::dvec3(0);
  double radius = 1;
  bool endless = false;  // objects reach beyond that sphere, so that a camera cannot go round them

  // Irradiance as a function of the surface position, in place of lights: test patterns. Averaged
  // over paintSamples^2 points of each pixel.
  std::function<glm::dvec3(const glm::dvec3&)> paint;
  int paintSamples = 1;

  std::vector<MaterialSource> materials = {PresetMaterial{"skin1"}};
  std::function<glm::dvec3(const glm::dvec3&)> albedo;  // by surface position; absent: no albedo image
};

// Checked values of a scene's options.
class OptionValues {
public:
  // Throws InputError on an option the scene does not have, listing those it has, and on a value out
  // of its range.
  OptionValues(const SceneInfo& info, const std::map<std::string, double>& given);
  double operator[](const std::string& name) const { return values_.at(name); }

private:
  std::map<std::string, double> values_;
};

struct SceneDefinition {
  SceneInfo info;
  SceneModel (*build)(const SceneParameters& parameters, const OptionValues& options);
};

// Throws InputError listing the scenes there are.
const SceneDefinition& findScene(const std::string& name);

// The scene with its camera and lights aimed and turned, ready to be cast; makeScene() throws likewise.
SceneModel sceneModel(const SceneParameters& parameters);

// One list per file of builders.
std::vector<SceneDefinition> solidScenes();
std::vector<SceneDefinition> patternScenes();
std::vector<SceneDefinition> clutterScenes();
std::vector<SceneDefinition> earScenes();
std::vector<SceneDefinition> headScenes();

// ---- Helpers of the builders

// How a builder places its camera; parameters decide the projection and the depth convention. The
// view is `extent` mm wide at the target in either projection.
struct CameraPlacement {
  glm::dvec3 eye, target;
  double extent;
  bool orthographic = false;  // unless the parameters say otherwise
  double nearPlane, farPlane;
};
Camera placeCamera(const SceneParameters& parameters, const CameraPlacement& placement);

// A light that gives irradiance E at normal incidence at `target`. `towardLight` need not be unit;
// `distance` and the cone are used when it is a point or a spot.
struct LightPlacement {
  glm::dvec3 target, towardLight;
  double irradiance = 1;
  PellucidLightType type = PELLUCID_LIGHT_DIRECTIONAL;  // unless the parameters say otherwise
  double distance = 200;                                // mm
  double coneRadius = 40;                               // mm lit around the target by a spot
  glm::dvec3 color = glm::dvec3(1);
};
Light placeLight(const SceneParameters& parameters, const LightPlacement& placement);

inline const SceneOption kExtent = {"extent", 40, 1e-3, 1e5, "visible width, mm"};
inline double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// Of scenes around the origin that are so wide: the camera on the z axis, and lights as far away as they
// need.
Camera frontCamera(const SceneParameters& parameters, double extent);
Light lightAt(const SceneParameters& parameters, const glm::dvec3& toward, double irradiance, double extent);

// Diffuse reflectance of skin1 (Jensen et al. 2001, figure 5).
inline glm::dvec3 skinAlbedo(const glm::dvec3&) { return {0.44, 0.22, 0.13}; }

}  // namespace pellucid::harness
