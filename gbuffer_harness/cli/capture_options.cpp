#include "cli/capture_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "cli/light_option.h"
#include "cli/numbers.h"
#include "common/error.h"
#include "raster/bodies.h"
#include "raster/framing.h"

namespace pellucid::harness {

namespace {

constexpr int kLargestSide = 8192;  // of RasterOptions

constexpr const char *kModelGroup = "Models", *kSceneGroup = "Procedural scenes";

// Fields that SceneParameters and RasterOptions have in common.
template <class Parameters>
void setCommon(const CaptureOptions& options, Parameters& to) {
  const std::vector<std::string> size = split(options.size.empty() ? "512x512" : options.size, 'x');
  if (size.size() != 2) throw UsageError("--size: \"" + options.size + "\" is not WIDTHxHEIGHT");
  to.width = parseNumber<int>("--size", size[0]);
  to.height = parseNumber<int>("--size", size[1]);
  to.infiniteFar = options.infiniteFar;
  to.normalsInViewSpace = options.viewNormals;
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
  if (options.camera.empty() && !cameras.empty()) return cameras.front();
  if (options.camera.empty() || options.camera == "auto") {
    Vector3 toCamera = {0, 0, 1};
    if (!options.view.empty()) {
      const std::vector<std::string> parts = split(options.view, ',');
      if (parts.size() != 3) throw UsageError("--view: \"" + options.view + "\" is not X,Y,Z");
      for (std::size_t i = 0; i < 3; ++i) toCamera[i] = parseNumber<double>("--view", parts[i]);
    }
    return frameModel(model, toCamera, options.verticalFov * std::numbers::pi / 180,
                      static_cast<double>(raster.width) / raster.height, options.orthographic.value_or(false),
                      turns);
  }
  std::string names = "auto";
  for (const ModelCamera& camera : cameras) {
    if (camera.name == options.camera) return camera;
    names += ", " + camera.name;
  }
  throw UsageError("--camera: there is no \"" + options.camera + "\" but " + names);
}

void refuseOptionsOf(const Command& command, const char* group, const char* needs) {
  for (const GivenOption& option : command.given())
    if (option.group == group) throw UsageError(option.name + ": needs " + needs);
}

std::array<double, 2> parsePair(const char* option, const std::string& text, const char* syntax) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 2) throw UsageError(std::string(option) + ": \"" + text + "\" is not " + syntax);
  return {parseNumber<double>(option, parts[0]), parseNumber<double>(option, parts[1])};
}

ShadowDrawing shadowDrawing(const CaptureOptions& options) {
  ShadowDrawing drawing;
  drawing.cull = options.shadowCull;
  drawing.bits = options.shadowBits;
  drawing.normalOffset = options.shadowNormalOffset;
  drawing.cascades = options.shadowCascades;
  drawing.filter = options.shadowFilter;
  drawing.placement = options.shadowAtlas   ? MapPlacement::Atlas
                      : options.shadowArray ? MapPlacement::Array
                                            : MapPlacement::Separate;
  if (options.shadowDepthBias.empty()) return drawing;
  const auto [constant, slope] = parsePair("--shadow-depth-bias", options.shadowDepthBias, "CONSTANT,SLOPE");
  drawing.depthBiasConstant = constant;
  drawing.depthBiasSlope = slope;
  return drawing;
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
  command.flag("--view-normals", options.viewNormals, "normals in view instead of world space");
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
      "NAME=PRESET, NAME={...} or NAME=thin:R,G,B, a thin wall's transmittance; NAME * means all others");
  command.option(
      "--light", options.lights,
      std::string("of a scene: directional, point or spot; of a model, repeatable: ") + kLightSyntax);
}

void addModelOptions(const Command& command, CaptureOptions& options, SceneUse use) {
  const Command models = command.group(kModelGroup);
  command.option("model", options.model, "glTF file, .glb or .gltf");
  models.option("--unit", options.unit, "mm, cm, m or a number of meters: the length of the file's unit");
  const CommandOption time =
      models
          .option("--time", options.time, "seconds into the file's animation (default: nodes as they stand)")
          .notNegative();
  models.option("--animation", options.animation, "name or number from 0 (default: the first)").needs(time);
  models.flag("--fill-holes", options.fillHoles, "close the holes of bodies that have a material");
  models.option("--camera", options.camera, "name of one of the file's cameras, or auto");
  models.option("--view", options.view, "X,Y,Z: direction from the center to the auto camera");
  models.option("--fov", options.verticalFov, "vertical field of view of the auto camera, degrees")
      .range(1.0, 170.0);
  models.choice("--back", options.backFace,
                {{"nearest", BackFace::Nearest}, {"farthest", BackFace::Farthest}},
                "which back face behind the front: nearest or farthest");
  models
      .option("--point-maps", options.pointMaps,
              "shadow maps of a point light: 1, 6 or auto, 6 where 1 cannot see the whole model")
      .oneOf({"auto", "1", "6"});
  models.option("--simplify", options.simplify,
                "share of the triangles that back depth and shadow maps are drawn with, above 0 (default 1)");
  models.choice("--shadow-cull", options.shadowCull,
                {{"none", MapCull::None}, {"back", MapCull::Back}, {"front", MapCull::Front}},
                "faces that shadow maps leave out: none (default), back or front");
  models.option("--shadow-depth-bias", options.shadowDepthBias,
                "CONSTANT,SLOPE: factors of vkCmdSetDepthBias, away from the light");
  models.option("--shadow-bits", options.shadowBits, "of a shadow map's depth: 16, 24 or 32, a float")
      .oneOf({16, 24, 32});
  models
      .option(
          "--shadow-normal-offset", options.shadowNormalOffset,
          "texels times 1 - cosine to the light by which a map's vertices move inward along their normals")
      .range(0.0, 100.0);
  models
      .option("--shadow-cascades", options.shadowCascades,
              "maps of a directional light that follow the camera; 0: one around the model")
      .range(0, 6);
  models
      .option(
          "--shadow-filter", options.shadowFilter,
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
    const std::vector<std::string> numbers = split(text, ',');
    if (numbers.size() != 3) fail();
    std::array<double, 3> result;
    for (std::size_t c = 0; c < 3; ++c) {
      result[c] = parseNumber<double>("--environment", numbers[c]);
      if (!(result[c] >= 0)) fail();
    }
    return result;
  };
  if (parts[0] == "uniform" && parts.size() == 2) return Environment{color(parts[1]), color(parts[1])};
  if (parts[0] != "gradient" || parts.size() != 3) fail();
  return Environment{color(parts[1]), color(parts[2])};
}

namespace {

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
  setCommon(options, result.raster);
  result.raster.backFace = options.backFace;
  result.raster.pointMaps = options.pointMaps == "1"   ? PointMaps::One
                            : options.pointMaps == "6" ? PointMaps::Six
                                                       : PointMaps::Auto;
  result.raster.shadow = shadowDrawing(options);
  if (!options.jitter.empty()) result.raster.jitter = parsePair("--jitter", options.jitter, "X,Y");
  result.raster.simplify = options.simplify;
  GltfOptions gltf;
  gltf.metersPerUnit = parseUnit(options.unit);
  for (const std::string& text : options.presets) {
    const Assignment set = parseAssignment("--material", text);
    gltf.presets[set.key] = set.value;
  }
  gltf.ior = options.ior.value_or(0);
  gltf.time = options.time;
  gltf.animation = options.animation;
  gltf.camera = options.camera;
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
  if (options.size.empty() && result.camera.aspect > 0)
    result.raster.width = static_cast<int>(
        std::clamp(std::round(result.raster.height * result.camera.aspect), 1.0, double(kLargestSide)));
  std::vector<std::string> lights = options.lights;
  if (lights.empty() && result.model.lights.empty()) {
    lights = lightsOfNone;
    std::string names;
    for (const std::string& light : lights) names += " --light " + light;
    result.warnings.push_back("the file has no lights; added:" + names);
  }
  if (!lights.empty()) result.model.lights.clear();
  for (const std::string& light : lights)
    result.model.lights.push_back(parseLight(light, result.model, result.camera));
  return result;
}

}  // namespace pellucid::harness
