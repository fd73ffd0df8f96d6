#include "cli/scene_capture.h"

#include <algorithm>
#include <iterator>

#include "raster/bodies.h"
#include "reference/path_tracer/visible_surface.h"
#include "scene/model.h"

namespace pellucid::harness {

namespace {

// Noise of some 2 % in half shadow, which diffusion averages further.
constexpr int kSamples = 512;
// Transmission blurs them.
constexpr int kHiddenSamples = 128;

bool hasRadius(const Light& light) { return light.radius > 0; }

bool needsTracing(const std::vector<Light>& lights, const std::optional<Environment>& environment) {
  return environment || std::any_of(lights.begin(), lights.end(), hasRadius);
}

}  // namespace

Capture captureScene(const SceneParameters& scene, const CaptureOptions& options) {
  Capture capture = makeScene(scene);
  setIor(capture.materials, options);
  if (const std::optional<Environment> sky = environment(options)) {
    const SceneModel model = sceneModel(scene);
    addTracedLight(capture, *reference::makeSolidScene(model), sky);
  }
  return capture;
}

RasterResult captureScene(Device& device, const Model& model, const ModelCamera& camera,
                          const RasterOptions& raster, const std::optional<Environment>& environment) {
  refuseEnclosedLights(model);
  RasterResult result = rasterize(device, model, camera, raster);
  if (!needsTracing(model.lights, environment)) return result;
  const Image drawn = result.capture.irradiance;
  addTracedLight(result.capture, *reference::makeMeshScene(model), environment);
  for (std::size_t i = 0; i < result.reflectedShare.data.size(); ++i) {
    float& irradiance = result.capture.irradiance.data[i];
    irradiance = drawn.data[i] + (irradiance - drawn.data[i]) * result.reflectedShare.data[i];
  }
  return result;
}

void addTracedLight(Capture& capture, const reference::TraceScene& scene,
                    const std::optional<Environment>& environment) {
  if (!needsTracing(capture.lights, environment)) return;
  if (environment) capture.environment = environment->harmonics();
  reference::Emitters emitters;
  emitters.environment = environment;
  std::copy_if(capture.lights.begin(), capture.lights.end(), std::back_inserter(emitters.lights), hasRadius);
  for (Light& light : emitters.lights) light.shadowMaps.clear();
  const reference::VisibleSurface visible = reference::visibleSurface(capture, scene);
  const Image added = reference::tracedIrradiance(visible, scene, emitters, kSamples);
  for (std::size_t i = 0; i < added.data.size(); ++i) capture.irradiance.data[i] += added.data[i];
  if (!environment || capture.backDepth.image.empty()) return;
  emitters.lights.clear();  // they come through by their maps
  capture.hiddenIrradiance = reference::tracedIrradiance(reference::hiddenSurface(capture, scene, visible),
                                                         scene, emitters, kHiddenSamples);
}

}  // namespace pellucid::harness
