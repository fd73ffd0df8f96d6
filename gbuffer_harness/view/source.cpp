#include "view/source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "metrics/surface.h"
#include "raster/bodies.h"
#include "raster/rasterizer.h"
#include "scene/model.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

std::vector<ViewLight> viewLights(const std::vector<Light>& lights) {
  std::vector<ViewLight> result;
  for (const Light& light : lights) result.push_back({light, true});
  for (ViewLight& light : result) light.light.shadowMaps.clear();
  return result;
}

std::vector<Light> lit(const std::vector<ViewLight>& lights) {
  std::vector<Light> result;
  for (const ViewLight& light : lights)
    if (light.on) result.push_back(light.light);
  return result;
}

class ModelSource : public Source {
public:
  ModelSource(Device& device, Model model, const ModelCamera& camera, const RasterOptions& raster)
      : model_(std::move(model)), raster_(raster), rasterizer_(device, model_) {
    const Bounds bounds = boundsOf(model_);
    start_.center = bounds.center;
    radius_ = bounds.radius;
    start_.width = raster.width;
    start_.height = raster.height;
    start_.camera = {camera, start_.center};
    start_.lights = viewLights(model_.lights);
    start_.materials = model_.materials;
  }

  bool drawsMaterials() const override {
    return std::any_of(model_.surfaces.begin(), model_.surfaces.end(),
                       [](const Surface& surface) { return surface.hasReflectance; });
  }
  std::vector<MaterialSource> materials(const ViewState& state) const override {
    return withBodies(state.materials, model_.bodies);
  }

  Scene render(const ViewState& state) override {
    RasterOptions options = raster_;
    options.width = state.width;
    options.height = state.height;
    model_.lights = lit(state.lights);
    model_.materials = state.materials;
    takeReflectances();
    std::shared_ptr<const DrawnFrame> drawn = rasterizer_.draw(state.camera.lens, options);
    return {drawn->outline, drawn, drawn->warnings()};
  }

private:
  // Colors of surfaces that have none of their own.
  void takeReflectances() {
    const std::vector<MaterialSource> materials = withBodies(model_.materials, model_.bodies);
    for (Surface& surface : model_.surfaces) {
      if (!surface.hasReflectance) continue;
      const std::size_t i = surface.material - 1u;
      const MaterialSource& source = materials.at(i);
      const std::string key = materialJson(source).dump();
      const auto [entry, isNew] = reflectances_.try_emplace(key);
      if (isNew) {
        const PellucidMaterial compiled = compileMaterial(source, "materials[" + std::to_string(i) + "]");
        std::copy_n(compiled.reflectance, 3, entry->second.begin());
      }
      surface.baseColor = entry->second;
    }
  }

  Model model_;
  std::map<std::string, std::array<double, 3>> reflectances_;  // of compiled materials, by their JSON
  RasterOptions raster_;
  Rasterizer rasterizer_;  // of model_
};

class SceneSource : public Source {
public:
  SceneSource(const SceneParameters& parameters, const std::vector<MaterialSource>& materials)
      : parameters_(parameters), scene_(sceneModel(parameters)) {
    scene_.materials = materials;
    start_.center = fromGlm(scene_.center);
    radius_ = scene_.radius;
    if (scene_.endless) fixedCamera_ = "this scene has no end, so its camera stays where it is";
    if (scene_.paint) fixedLights_ = "this scene has a painted irradiance, and no lights";
    ViewCamera& camera = start_.camera;
    camera.pivot = start_.center;
    camera.lens.name = parameters.name;
    camera.lens.viewFromWorld = scene_.camera.viewFromWorld;
    camera.lens.orthographic = scene_.camera.orthographic;
    // Rows of perspective() and orthographic().
    const double scale = std::abs(scene_.camera.clipFromView[5]);
    if (scene_.camera.orthographic)
      camera.lens.height = 2 / scale;
    else
      camera.lens.verticalFov = 2 * std::atan(1 / scale);
    camera.lens.range = scene_.camera.range;
    start_.width = parameters.width;
    start_.height = parameters.height;
    start_.lights = viewLights(scene_.lights);
    start_.materials = materials;
  }

  Scene render(const ViewState& state) override {
    parameters_.width = state.width;
    parameters_.height = state.height;
    const ModelCamera& lens = state.camera.lens;
    const double aspect = static_cast<double>(state.width) / state.height;
    scene_.camera.viewFromWorld = lens.viewFromWorld;
    scene_.camera.range = lens.range;
    scene_.camera.range.reversed = parameters_.reversedZ;
    if (parameters_.infiniteFar) scene_.camera.range.farPlane = std::numeric_limits<double>::infinity();
    scene_.camera.clipFromView = lens.orthographic
                                     ? orthographic(lens.height * aspect, lens.height, scene_.camera.range)
                                     : perspective(lens.verticalFov, aspect, scene_.camera.range);
    if (!scene_.paint) scene_.lights = lit(state.lights);
    scene_.materials = state.materials;
    return {renderCapture(scene_, parameters_), nullptr, {}};
  }

private:
  SceneParameters parameters_;
  SceneModel scene_;
};

class CaptureSource : public Source {
public:
  explicit CaptureSource(Capture capture) : capture_(std::move(capture)) {
    start_.width = capture_.width;
    start_.height = capture_.height;
    start_.camera.lens.viewFromWorld = capture_.viewFromWorld;
    start_.lights = viewLights(capture_.lights);
    start_.materials = capture_.materials;
    for (const Light& light : capture_.lights) maps_.push_back(light.shadowMaps);
    findCenter();
    start_.camera.pivot = start_.center;
    fixedCamera_ = "a capture is seen by its own camera";
    fixedLights_ =
        "the irradiance is the capture's: lights change what comes through, and stay where their shadow maps "
        "were drawn";
  }

  Scene render(const ViewState& state) override {
    Capture capture = capture_;
    capture.materials = state.materials;
    capture.lights.clear();
    for (std::size_t i = 0; i < state.lights.size(); ++i) {
      if (!state.lights[i].on) continue;
      capture.lights.push_back(state.lights[i].light);
      if (i < maps_.size()) capture.lights.back().shadowMaps = maps_[i];
    }
    return {std::move(capture), nullptr, {}};
  }

private:
  // The middle of what the camera sees, from the depths of the pixels that have a material.
  void findCenter() {
    const reference::Camera camera(capture_.clipFromView, capture_.width, capture_.height);
    const glm::dmat4 world = glm::inverse(toGlm(capture_.viewFromWorld));
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    forEachSurface(capture_, camera, [&](int x, int y, double depth) {
      const glm::dvec3 p(world * glm::dvec4(camera.position({x + 0.5, y + 0.5}, depth), 1));
      low = glm::min(low, p);
      high = glm::max(high, p);
    });
    if (!(low.x <= high.x)) return;
    start_.center = fromGlm(0.5 * (low + high));
    radius_ = std::max(0.5 * glm::length(high - low), 1e-9);
  }

  Capture capture_;
  std::vector<std::vector<ShadowMap>> maps_;
};

}  // namespace

std::unique_ptr<Source> modelSource(Device& device, Model model, const ModelCamera& camera,
                                    const RasterOptions& raster) {
  return std::make_unique<ModelSource>(device, std::move(model), camera, raster);
}

std::unique_ptr<Source> sceneSource(const SceneParameters& parameters,
                                    const std::vector<MaterialSource>& materials) {
  return std::make_unique<SceneSource>(parameters, materials);
}

std::unique_ptr<Source> captureSource(Capture capture) {
  return std::make_unique<CaptureSource>(std::move(capture));
}

}  // namespace pellucid::harness
