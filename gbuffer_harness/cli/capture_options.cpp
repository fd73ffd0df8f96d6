#include "cli/capture_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <numbers>
#include <tuple>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "cli/numbers.h"
#include "common/error.h"
#include "raster/bodies.h"
#include "raster/framing.h"
#include "reference/path_tracer/visible_surface.h"
#include "scene/model.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr int kLargestSide = 8192;  // of RasterOptions

constexpr const char *kModelGroup = "Models", *kSceneGroup = "Procedural scenes";

// Fields that SceneParameters and RasterOptions have in common.
template <class Parameters>
void setCommon(const CaptureOptions& options, Parameters& to) {
  const auto [width, height] = parseSize("--size", options.size.empty() ? "512x512" : options.size);
  to.width = width;
  to.height = height;
  to.infiniteFar = options.infiniteFar;
  to.reversedZ = options.reversedZ.value_or(to.reversedZ);
  to.depthEncoding = options.depth.value_or(to.depthEncoding);
  to.shadowEncoding = options.shadowDepth.value_or(to.shadowEncoding);
  to.shadowSize = options.shadowSize.value_or(to.shadowSize);
}

PellucidLightType parseLightType(const std::string& text) {
  const std::map<std::string, PellucidLightType> types = {{"directional", PELLUCID_LIGHT_DIRECTIONAL},
                                                          {"point", PELLUCID_LIGHT_POINT},
                                                          {"spot", PELLUCID_LIGHT_SPOT}};
  const auto found = types.find(text);
  if (found == types.end())
    throw UsageError("--light: \"" + text +
                     "\" is not directional, point or spot; a scene has its own position");
  return found->second;
}

ModelCamera chooseCamera(const CaptureOptions& options, const Model& model, const RasterOptions& raster,
                         const std::vector<double>& turns) {
  const std::vector<ModelCamera>& cameras = model.cameras;
  const std::string& wanted = options.gltf.camera;
  if (wanted.empty() && !cameras.empty()) return cameras.front();
  if (wanted.empty() || wanted == "auto") {
    Vector3 toCamera = {0, 0, 1};
    if (!options.view.empty()) toCamera = parseNumbers<3>("--view", options.view, "X,Y,Z");
    return frameModel(model, toCamera, options.verticalFov * std::numbers::pi / 180,
                      static_cast<double>(raster.width) / raster.height, options.orthographic.value_or(false),
                      turns);
  }
  std::string names = "auto";
  std::vector<ModelCamera> found, ofNode;
  for (const ModelCamera& camera : cameras) {
    if (camera.node == wanted) ofNode.push_back(camera);
    if (camera.name == wanted || camera.node == wanted) found.push_back(camera);
    names += ", " + camera.name + (camera.node.empty() || camera.node == camera.name ? "" : " (node " + camera.node + ")");
  }
  if (ofNode.size() == 1) return ofNode.front();  // Blender's objects and their data often have each other's names
  if (found.size() == 1) return found.front();
  if (found.empty()) throw UsageError("--camera: there is no \"" + wanted + "\" but " + names);
  throw UsageError("--camera: " + std::to_string(found.size()) + " cameras are called \"" + wanted + "\"; name a node: " + names);
}

void refuseOptionsOf(const Command& command, const char* group, const char* needs) {
  for (const GivenOption& option : command.given())
    if (option.group == group) throw UsageError(option.name + ": needs " + needs);
}

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

void addCommonOptions(const Command& command, CaptureOptions& options) {
  command.option(
      "--size", options.size,
      "WIDTHxHEIGHT in pixels (default: 512x512, and 512 high for a file's camera with an aspect)");
  command.choice("--projection", options.orthographic, {{"perspective", false}, {"orthographic", true}},
                 "perspective or orthographic (default: the scene's; of a model's auto camera: perspective)");
  command.flag("--reversed-z,!--forward-z", options.reversedZ,
               "device depth 1 at the near plane (default: a model yes, a scene no)");
  command.flag("--infinite-far", options.infiniteFar, "no far plane (perspective only)");
  command.choice("--depth", options.depth,
                 {{"viewz", PELLUCID_DEPTH_VIEW_Z}, {"device", PELLUCID_DEPTH_DEVICE}},
                 "viewz or device (default: a model device, a scene viewz)");
  command.choice("--shadow-depth", options.shadowDepth,
                 {{"viewz", PELLUCID_DEPTH_VIEW_Z},
                  {"device", PELLUCID_DEPTH_DEVICE},
                  {"distance", PELLUCID_DEPTH_DISTANCE}},
                 "viewz, device or distance (default: a model device, a scene viewz)");
  command.option("--ior", options.ior, "index of refraction of all materials, in place of their own")
      .range(1.0, 3.0);
  command.option("--environment", options.environment,
                 std::string("radiance from all around: ") + kEnvironmentSyntax);
  command.option("--shadow-size", options.shadowSize,
                 "texels across a shadow map; 0: none (default: a model 1024, a scene 512)");
  command.option(
      "--material", options.presets,
      "of a scene: *=PRESET or *={a manifest's material}, for all objects; of a model, repeatable: "
      "NAME=PRESET, NAME={...}, NAME=thin:R,G,B (a thin wall's transmittance), NAME=opaque or NAME=none, "
      "which leaves it out; NAME * means all others");
  command.option(
      "--light", options.lights,
      std::string("of a scene: directional, point or spot; of a model, repeatable: ") + kLightSyntax);
}

void addModelOptions(const Command& command, CaptureOptions& options, SceneUse use) {
  const Command models = command.group(kModelGroup);
  ShadowDrawing& shadow = options.raster.shadow;
  command.option("model", options.model, "glTF file, .glb or .gltf");
  models.option("--unit", options.unit, "mm, cm, m or a number of meters: the length of the file's unit");
  models.flag("--fill-holes", options.fillHoles, "close the holes of bodies that have a material");
  models.option("--scene", options.gltf.scene,
                "name or number of one of the file's scenes (default: the file's)");
  models.option("--camera", options.gltf.camera, "name of one of the file's cameras, or auto");
  models.option("--view", options.view, "X,Y,Z: direction from the center to the auto camera");
  models.option("--fov", options.verticalFov, "vertical field of view of the auto camera, degrees")
      .range(1.0, 170.0);
  models.choice("--back", options.raster.backFace,
                {{"nearest", BackFace::Nearest}, {"farthest", BackFace::Farthest}},
                "which back face behind the front: nearest or farthest");
  models.choice("--point-maps", options.raster.pointMaps,
                {{"auto", PointMaps::Auto}, {"1", PointMaps::One}, {"6", PointMaps::Six}},
                "shadow maps of a point light: 1, 6 or auto (default), 6 where 1 cannot see the whole model");
  models.option("--simplify", options.raster.simplify,
                "share of the triangles that back depth and shadow maps are drawn with, above 0 (default 1)");
  models.choice("--shadow-cull", shadow.cull,
                {{"none", MapCull::None}, {"back", MapCull::Back}, {"front", MapCull::Front}},
                "faces that shadow maps leave out: none (default), back or front");
  models.option("--shadow-depth-bias", options.shadowDepthBias,
                "CONSTANT,SLOPE: factors of vkCmdSetDepthBias, away from the light");
  models.option("--shadow-bits", shadow.bits, "of a shadow map's depth: 16, 24 or 32, a float")
      .oneOf({16, 24, 32});
  models
      .option(
          "--shadow-normal-offset", shadow.normalOffset,
          "texels times 1 - cosine to the light by which a map's vertices move inward along their normals")
      .range(0.0, 100.0);
  models
      .option("--shadow-cascades", shadow.cascades,
              "maps of a directional light that follow the camera; 0: one around the model")
      .range(0, 6);
  models
      .option(
          "--shadow-filter", shadow.filter,
          "taps across, odd, with which the irradiance filters these maps; 0: it has plain maps of its own")
      .oneOf({0, 1, 3, 5, 7, 9, 11, 13, 15});
  models.option(
      "--jitter", options.jitter,
      "X,Y in pixels, -1 .. 1, by which the projection moves the picture, as for temporal antialiasing");
  const CommandOption atlas =
      models.flag("--shadow-atlas", options.shadowAtlas, "all shadow maps as tiles of one image");
  models.flag("--shadow-array", options.shadowArray, "all shadow maps as layers of one image")
      .excludes(atlas);
  (use == SceneUse::Capture ? models : command)
      .option("--device", options.device, "part of the Vulkan device's name; default: the fastest kind");
}

void addSceneOptions(const Command& command, CaptureOptions& options, SceneUse use) {
  const Command scenes = command.group(kSceneGroup);
  scenes.option("--procedural", options.scene.name,
                "name of the scene; list: print all scenes with their options");
  scenes.option("--seed", options.scene.seed, "seed of scenes that scatter objects");
  scenes.option(use == SceneUse::Capture ? "--set" : "--scene-set", options.set,
                "key=value, repeatable: an option of the scene");
}

}  // namespace

void addCaptureOptions(const Command& command, CaptureOptions& options, SceneUse use) {
  addCommonOptions(command, options);
  addModelOptions(command, options, use);
  addSceneOptions(command, options, use);
}

bool isProcedural(const Command& command, const CaptureOptions& options) {
  if (options.scene.name.empty() == options.model.empty())
    throw UsageError(command.name() + ": either a model or --procedural is required");
  const bool procedural = options.model.empty();
  if (procedural)
    refuseOptionsOf(command, kModelGroup, "a model");
  else
    refuseOptionsOf(command, kSceneGroup, "--procedural");
  return procedural;
}

namespace {

SceneMaterial sceneMaterial(const CaptureOptions& options) {
  const Assignment set = parseAssignment("--material", options.presets.front());
  if (options.presets.size() > 1 || set.key != "*")
    throw UsageError("--material: the objects of a procedural scene have no names; *=PRESET is all of them");
  SceneMaterial material{parseMaterial("--material *", set.value), {}};
  if (options.ior) material.source = withIor(material.source, *options.ior, "--material *");
  const PellucidMaterial compiled = compileMaterial(material.source, "--material *");
  std::copy_n(compiled.reflectance, 3, material.albedo.begin());
  return material;
}

}  // namespace

SceneParameters procedural(const CaptureOptions& options) {
  SceneParameters scene = options.scene;
  if (!options.presets.empty()) scene.material = sceneMaterial(options);
  setCommon(options, scene);
  scene.orthographic = options.orthographic;
  if (options.lights.size() > 1) throw UsageError("--light: a procedural scene has one light");
  if (!options.lights.empty()) scene.lightType = parseLightType(options.lights.front());
  for (const std::string& text : options.set) {
    const Assignment set = parseAssignment("--set", text);
    scene.options[set.key] = parseNumber<double>("--set " + set.key, set.value);
  }
  return scene;
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

void say(const CaptureModel& model) {
  for (const std::string& note : model.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  warn(model.warnings);
}

void requireTranslucent(const CaptureModel& model) {
  if (!model.model.materials.empty()) return;
  std::string names;
  for (const std::string& name : model.materialNames) names += (names.empty() ? "" : ", ") + name;
  throw InputError(
      model.model.name, "materials",
      "none is translucent; --material NAME=PRESET makes one so, as in --material '*=skin1'; there are " +
          names);
}

void setIor(std::vector<MaterialSource>& materials, const CaptureOptions& options) {
  if (!options.ior) return;
  for (std::size_t i = 0; i < materials.size(); ++i)
    materials[i] =
        withIor(materials[i], *options.ior, options.scene.name + ": materials[" + std::to_string(i) + "]");
}

std::optional<Environment> environment(const CaptureOptions& options) {
  if (options.environment.empty()) return std::nullopt;
  const std::vector<std::string> parts = split(options.environment, ':');
  const auto fail = [&] {
    throw UsageError("--environment: \"" + options.environment + "\" is not " + kEnvironmentSyntax);
  };
  const auto color = [&](const std::string& text) {
    const std::array<double, 3> result = parseNumbers<3>("--environment", text, kEnvironmentSyntax);
    if (!std::all_of(result.begin(), result.end(), [](double channel) { return channel >= 0; })) fail();
    return result;
  };
  if (parts[0] == "uniform" && parts.size() == 2) return Environment{color(parts[1]), color(parts[1])};
  if (parts[0] != "gradient" || parts.size() != 3) fail();
  return Environment{color(parts[1]), color(parts[2])};
}

double parseUnit(const std::string& text) {
  if (text == "mm") return 0.001;
  if (text == "cm") return 0.01;
  if (text == "m") return 1;
  const double meters = parseNumber<double>("--unit", text);
  if (!(meters >= 1e-9 && meters <= 1e9))
    throw UsageError("--unit: \"" + text + "\" is not a length from 1e-9 to 1e9 meters");
  return meters;
}

Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera) {
  Light light;
  if (text == kBackLight || text == kFrontLight) {
    // Columns of viewFromWorld's transpose are the view's axes in the world; +z is towards the camera.
    const Matrix& m = camera.viewFromWorld;
    const double sign = text == kBackLight ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i) light.direction[i] = sign * m[4 * i + 2] - 0.4 * m[4 * i + 1];
    return light;
  }
  std::vector<std::string> parts = split(text, ':');
  const bool sphere = parts[0] == "sphere" && parts.size() >= 3;
  if (sphere) {
    light.radius = parseNumber<double>("--light", parts[2]);
    if (!(light.radius > 0)) throw UsageError("--light: \"" + text + "\": the radius is not above 0");
    parts.erase(parts.begin() + 2);
  }
  const bool known = parts[0] == "directional" || parts[0] == "point" || parts[0] == "spot" || sphere;
  if (!known || parts.size() > 3 || parts.size() < 2)
    throw UsageError("--light: \"" + text + "\" is not " + kLightSyntax);
  Vector3 where = parseNumbers<3>("--light", parts[1], kLightSyntax);
  if (parts[0] == "directional") {
    light.direction = where;
  } else {
    for (std::size_t i = 0; i < 3; ++i) where[i] -= model.origin[i];
    const Bounds bounds = boundsOf(model);
    const double away = distance(where, bounds.center);
    light.type = parts[0] == "spot" ? PELLUCID_LIGHT_SPOT : PELLUCID_LIGHT_POINT;
    light.position = where;
    light.intensity = away * away;
    if (away == 0 && parts.size() < 3)
      throw UsageError("--light: \"" + text +
                       "\" stands at the center, where no intensity makes 1 arrive; add :I");
    if (light.radius > 0 && away < bounds.radius + light.radius)
      throw UsageError("--light: \"" + text + "\" reaches into the model's surroundings");
    if (light.type == PELLUCID_LIGHT_SPOT) {
      if (away == 0) throw UsageError("--light: \"" + text + "\" stands at the center it looks at");
      for (std::size_t i = 0; i < 3; ++i) light.direction[i] = (bounds.center[i] - where[i]) / away;
      light.outerConeAngle = bounds.radius < away ? std::asin(bounds.radius / away) : std::numbers::pi / 4;
      light.innerConeAngle = 0.8 * light.outerConeAngle;
    }
  }
  if (parts.size() == 3) light.intensity = parseNumber<double>("--light", parts[2]);
  fitLight(light, [&](const char* key, const std::string& sentence) {
    throw UsageError("--light: \"" + text + "\": " + key + " " + sentence);
  });
  return light;
}

namespace {

// A file's camera may cut the model: what lies before its near plane is not drawn, and a back beyond its far plane gives no depth.
void warnOfPlanes(const Model& model, const ModelCamera& camera, std::vector<std::string>& warnings) {
  const glm::dmat4 view = toGlm(camera.viewFromWorld);
  std::size_t before = 0, beyond = 0;
  for (const Vertex& vertex : model.vertices) {
    const double ahead = -(view * glm::dvec4(positionOf(vertex), 1)).z;
    before += ahead > 0 && ahead < camera.range.nearPlane;
    beyond += ahead > camera.range.farPlane;
  }
  for (const auto& [cut, plane, value, place] : {std::tuple(before, "znear", camera.range.nearPlane, "before"),
                                                {beyond, "zfar", camera.range.farPlane, "beyond"}})
    if (cut > 0)
      warnings.push_back("camera \"" + camera.name + "\": its " + plane + ", " + std::to_string(value) + ", cuts the model: " +
                         std::to_string(cut) + " vertices lie " + place + " it");
}

// raster/bodies.h, with a note.
void separateBodies(CaptureModel& model) {
  std::vector<double> reach;
  for (std::size_t i = 0; i < model.model.materials.size(); ++i) {
    const PellucidMaterial compiled = compileMaterial(
        model.model.materials[i], model.model.name + ": materials[" + std::to_string(i) + "]");
    reach.push_back(static_cast<double>(*std::max_element(compiled.radius, compiled.radius + 3)));
  }
  const BodySeparation separated = separateBodies(model.model, reach);
  if (separated.added > 0)
    model.notes.push_back(
        "of " + std::to_string(separated.bodies) + " bodies some of one medium are near each other: " +
        std::to_string(separated.added) + " more numbers keep light from crossing the air between them");
}

}  // namespace

CaptureModel captureModel(const CaptureOptions& options, const std::vector<double>& turns,
                          const std::vector<std::string>& lightsOfNone) {
  CaptureModel result;
  result.raster = options.raster;
  setCommon(options, result.raster);
  ShadowDrawing& shadow = result.raster.shadow;
  if (options.shadowAtlas) shadow.placement = MapPlacement::Atlas;
  if (options.shadowArray) shadow.placement = MapPlacement::Array;
  if (!options.shadowDepthBias.empty()) {
    const auto bias = parseNumbers<2>("--shadow-depth-bias", options.shadowDepthBias, "CONSTANT,SLOPE");
    shadow.depthBiasConstant = bias[0];
    shadow.depthBiasSlope = bias[1];
  }
  if (!options.jitter.empty()) result.raster.jitter = parseNumbers<2>("--jitter", options.jitter, "X,Y");
  GltfOptions gltf = options.gltf;
  gltf.metersPerUnit = parseUnit(options.unit);
  for (const std::string& text : options.presets) {
    const Assignment set = parseAssignment("--material", text);
    gltf.presets[set.key] = set.value;
  }
  gltf.ior = options.ior.value_or(0);
  GltfScene scene = loadGltf(options.model, gltf);
  result.model = std::move(scene.model);
  result.notes = std::move(scene.notes);
  result.warnings = std::move(scene.warnings);
  result.materialNames = std::move(scene.materialNames);
  if (options.fillHoles) {
    const std::size_t filled = fillHoles(result.model);
    result.warnings.push_back("--fill-holes: " + std::to_string(filled) + " holes filled");
  }
  separateBodies(result);
  result.camera = chooseCamera(options, result.model, result.raster, turns);
  warnOfPlanes(result.model, result.camera, result.warnings);
  if (options.size.empty() && result.camera.aspect > 0)
    result.raster.width = static_cast<int>(
        std::clamp(std::round(result.raster.height * result.camera.aspect), 1.0, double(kLargestSide)));
  std::vector<std::string> lights = options.lights;
  if (lights.empty() && result.model.lights.empty()) {
    lights = lightsOfNone;
    std::string names;
    for (const std::string& light : lights) names += " --light " + light;
    result.warnings.push_back("the scene has no visible lights; added:" + names);
  }
  if (!lights.empty()) result.model.lights.clear();
  for (const std::string& light : lights)
    result.model.lights.push_back(parseLight(light, result.model, result.camera));
  for (std::string& sentence : openLamps(result.model)) result.warnings.push_back(std::move(sentence));
  return result;
}

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
