#include "cli/capture_gltf.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "capture/write.h"
#include "cli/numbers.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "raster/framing.h"

namespace pellucid::harness {

namespace {

constexpr const char* kBackLight = "back";

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

ModelCamera chooseCamera(const GltfCapture& options, const Model& model) {
  const std::vector<ModelCamera>& cameras = model.cameras;
  if (options.camera.empty() && !cameras.empty()) return cameras.front();
  if (options.camera.empty() || options.camera == "auto")
    return frameModel(model, options.toCamera, options.verticalFov * std::numbers::pi / 180,
                      static_cast<double>(options.raster.width) / options.raster.height, options.orthographic,
                      options.cameraTurns);
  std::string names = "auto";
  for (const ModelCamera& camera : cameras) {
    if (camera.name == options.camera) return camera;
    names += ", " + camera.name;
  }
  throw UsageError("--camera: there is no \"" + options.camera + "\" but " + names);
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

}  // namespace

double parseUnit(const std::string& text) {
  if (text == "mm") return 0.001;
  if (text == "cm") return 0.01;
  if (text == "m") return 1;
  const double meters = parseNumber<double>("--unit", text);
  if (!(meters > 0 && meters < 1e9)) throw UsageError("--unit: \"" + text + "\" is not a length in meters");
  return meters;
}

Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera) {
  Light light;
  if (text == kBackLight) {
    // Columns of viewFromWorld's transpose are the view's axes in the world; +z is towards the camera.
    const Matrix& m = camera.viewFromWorld;
    for (std::size_t i = 0; i < 3; ++i) light.direction[i] = m[4 * i + 2] - 0.4 * m[4 * i + 1];
    return light;
  }
  const std::vector<std::string> parts = split(text, ':');
  const std::vector<std::string> numbers = split(parts.size() > 1 ? parts[1] : "", ',');
  const bool known = parts[0] == "directional" || parts[0] == "point" || parts[0] == "spot";
  if (!known || parts.size() > 3 || numbers.size() != 3)
    throw UsageError("--light: \"" + text + "\" is not " + kLightSyntax);
  Vector3 where;
  for (std::size_t i = 0; i < 3; ++i) where[i] = parseNumber<double>("--light", numbers[i]);
  if (parts[0] == "directional") {
    light.direction = where;
    if (distance(where, {0, 0, 0}) == 0) throw UsageError("--light: \"" + text + "\" has no direction");
  } else {
    const Bounds bounds = boundsOf(model);
    const double away = distance(where, bounds.center);
    light.type = parts[0] == "spot" ? PELLUCID_LIGHT_SPOT : PELLUCID_LIGHT_POINT;
    light.position = where;
    light.intensity = away * away;
    if (away == 0 && parts.size() < 3)
      throw UsageError("--light: \"" + text +
                       "\" stands at the center, where no intensity makes 1 arrive; add :I");
    if (light.type == PELLUCID_LIGHT_SPOT) {
      if (away == 0) throw UsageError("--light: \"" + text + "\" stands at the center it looks at");
      for (std::size_t i = 0; i < 3; ++i) light.direction[i] = (bounds.center[i] - where[i]) / away;
      light.outerConeAngle = bounds.radius < away ? std::asin(bounds.radius / away) : std::numbers::pi / 4;
      light.innerConeAngle = 0.8 * light.outerConeAngle;
    }
  }
  if (parts.size() == 3) light.intensity = parseNumber<double>("--light", parts[2]);
  if (!(light.intensity >= 0 && light.intensity < 1e30))
    throw UsageError("--light: \"" + text + "\": the intensity is not >= 0");
  return light;
}

void captureGltf(const GltfCapture& options) {
  GltfScene scene = loadGltf(options.model, options.gltf);
  for (const std::string& note : scene.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  warn(scene.warnings);
  const ModelCamera camera = chooseCamera(options, scene.model);
  std::vector<std::string> lights = options.lights;
  if (lights.empty() && scene.model.lights.empty()) {
    lights = {kBackLight};
    warn({"the file has no lights: --light back is added"});
  }
  if (!lights.empty()) scene.model.lights.clear();
  for (const std::string& light : lights)
    scene.model.lights.push_back(parseLight(light, scene.model, camera));

  Device device({options.device, false});
  const Vector3 center = boundsOf(scene.model).center;
  const std::vector<Light> still = scene.model.lights;
  std::set<std::string> said;  // a turntable's frames have most warnings in common
  Progress progress("capturing", options.frames.size());
  for (const CaptureFrame& frame : options.frames) {
    ModelCamera turned = camera;
    turned.viewFromWorld = turnedView(camera.viewFromWorld, center, frame.turn.camera.value_or(0));
    for (std::size_t i = 0; i < still.size(); ++i)
      scene.model.lights[i] = turnedLight(still[i], center, frame.turn.lights.value_or(0));
    const RasterResult result = rasterize(device, scene.model, turned, options.raster);
    for (const std::string& warning : result.warnings)
      if (said.insert(warning).second) warn({frame.output.string() + ": " + warning});
    writeWhole(frame.output, [&](const auto& file) { writeCapture(result.capture, file); });
    progress.advance();
  }
  std::printf("%s: %zu triangles, %zu materials, camera %s, %zu lights on %s\nwrote %s%s\n",
              options.model.c_str(), scene.model.indices.size() / 3, scene.model.materials.size(),
              camera.name.c_str(), scene.model.lights.size(), device.description().c_str(),
              options.frames.front().output.c_str(),
              options.frames.size() > 1 ? (" .. " + options.frames.back().output.string()).c_str() : "");
}

}  // namespace pellucid::harness
