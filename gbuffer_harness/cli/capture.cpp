// `pellucid capture`: a capture of a procedural scene, or of a glTF file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>

#include "capture/write.h"
#include "cli/capture_gltf.h"
#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/numbers.h"
#include "cli/output.h"
#include "common/error.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "scene/scene.h"

namespace pellucid::harness {

namespace {

// Options of both kinds of capture stand outside the two; absent ones have each kind's own default.
struct Options {
  std::string output, size = "512x512";
  bool infiniteFar = false, viewNormals = false;
  std::optional<bool> reversedZ, orthographic;
  std::optional<PellucidDepthEncoding> depth, shadowDepth;
  std::optional<int> shadowSize;
  std::vector<std::string> lights;

  SceneParameters scene;
  std::vector<std::string> set;

  int turntable = 0, lightTurntable = 0;  // frames of one turn; 0: none
  bool orbit = false;
  std::string frames;

  GltfCapture gltf;
  std::string unit = "m", view, pointMaps = "auto";
  std::vector<std::string> presets;
};

constexpr const char *kModelGroup = "Models", *kSceneGroup = "Procedural scenes";

void printScenes() {
  for (const SceneInfo& scene : listScenes()) {
    std::cout << scene.name << ": " << scene.description << "\n";
    for (const SceneOption& option : scene.options) {
      std::cout << "    " << std::left << std::setw(13) << option.name << option.description << " (default "
                << option.defaultValue << ", " << option.minimum << " .. " << option.maximum << ")\n";
    }
  }
}

// Fields that SceneParameters and RasterOptions have in common.
template <class Parameters>
void setCommon(const Options& options, Parameters& to) {
  const std::vector<std::string> size = split(options.size, 'x');
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

// The model turns before a fixed camera, or with --orbit the camera goes round the model, and the lights turn
// at their own speed. As captures keep the model where it is, camera and lights turn back by its angle.
Turn turnAt(const Options& options, int frame) {
  const auto angle = [&](int frames) { return 2 * std::numbers::pi * ((frame - 1) % frames) / frames; };
  Turn turn;
  if (options.lightTurntable > 0) turn.lights = angle(options.lightTurntable);
  if (options.turntable > 0) {
    const double model = angle(options.turntable);
    turn.camera = options.orbit ? model : -model;
    if (!options.orbit) turn.lights = turn.lights.value_or(0) - model;
  }
  return turn;
}

std::vector<CaptureFrame> framesOf(const Options& options) {
  const int turns = options.turntable > 0 ? options.turntable : options.lightTurntable;
  if (turns == 0) {
    if (options.orbit) throw UsageError("--orbit: needs --turntable");
    if (!options.frames.empty()) throw UsageError("--frames: needs --turntable or --light-turntable");
    return {{options.output, {}}};
  }
  if (options.orbit && options.turntable == 0) throw UsageError("--orbit: needs --turntable");
  const FramePattern output("-o", options.output);
  std::vector<CaptureFrame> frames;
  for (const int frame :
       parseFrames(options.frames.empty() ? "1-" + std::to_string(turns) : options.frames)) {
    if (frame < 1) throw UsageError("--frames: a turntable begins at frame 1");
    frames.push_back({output(frame), turnAt(options, frame)});
  }
  return frames;
}

void captureProcedural(const Options& options) {
  SceneParameters scene = options.scene;
  setCommon(options, scene);
  scene.orthographic = options.orthographic;
  if (options.lights.size() > 1) throw UsageError("--light: a procedural scene has one light");
  if (!options.lights.empty()) scene.lightType = parseLightType(options.lights.front());
  for (const std::string& text : options.set) {
    const Assignment set = parseAssignment("--set", text);
    scene.options[set.key] = parseNumber<double>("--set " + set.key, set.value);
  }
  const std::vector<CaptureFrame> frames = framesOf(options);
  Progress progress("capturing", frames.size());
  for (const CaptureFrame& frame : frames) {
    scene.turn = frame.turn;
    const Capture capture = makeScene(scene);
    writeWhole(frame.output, [&](const auto& file) { writeCapture(capture, file); });
    progress.advance();
  }
}

void captureModel(const Options& options) {
  GltfCapture gltf = options.gltf;
  setCommon(options, gltf.raster);
  gltf.frames = framesOf(options);
  // A degree apart is enough for any turntable: the auto camera leaves a margin.
  const int turns = std::min(options.turntable, 360);
  for (int i = 1; i < turns; ++i) gltf.cameraTurns.push_back(2 * std::numbers::pi * i / turns);
  gltf.orthographic = options.orthographic.value_or(false);
  gltf.raster.pointMaps = options.pointMaps == "1"   ? PointMaps::One
                          : options.pointMaps == "6" ? PointMaps::Six
                                                     : PointMaps::Auto;
  gltf.lights = options.lights;
  gltf.gltf.metersPerUnit = parseUnit(options.unit);
  for (const std::string& text : options.presets) {
    const Assignment set = parseAssignment("--material", text);
    gltf.gltf.presets[set.key] = set.value;
  }
  if (!options.view.empty()) {
    const std::vector<std::string> parts = split(options.view, ',');
    if (parts.size() != 3) throw UsageError("--view: \"" + options.view + "\" is not X,Y,Z");
    for (std::size_t i = 0; i < 3; ++i) gltf.toCamera[i] = parseNumber<double>("--view", parts[i]);
  }
  captureGltf(gltf);
}

// An option without effect is a mistake of who gave it.
void refuseOptionsOf(const CLI::App& command, const char* group, const char* needs) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == group && option->count() > 0)
      throw UsageError(option->get_name() + ": needs " + needs);
}

void capture(const CLI::App& command, const Options& options) {
  if (options.scene.name == "list") return printScenes();
  if (options.scene.name.empty() == options.gltf.model.empty())
    throw UsageError("capture: either a model or --procedural is required");
  if (options.output.empty()) throw UsageError("capture: -o is required");
  requireExr("-o", options.output);
  const bool procedural = options.gltf.model.empty();
  if (procedural)
    refuseOptionsOf(command, kModelGroup, "a model");
  else
    refuseOptionsOf(command, kSceneGroup, "--procedural");
  return procedural ? captureProcedural(options) : captureModel(options);
}

void addCommonOptions(CLI::App& command, Options& options) {
  command.add_option("-o,--output", options.output, "EXR to write, the manifest embedded");
  command.add_option("--size", options.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  const std::map<std::string, bool> projections = {{"perspective", false}, {"orthographic", true}};
  command
      .add_option("--projection", options.orthographic,
                  "perspective or orthographic (default: the scene's; of a model's auto camera: perspective)")
      ->transform(CLI::CheckedTransformer(projections, CLI::ignore_case));
  command.add_flag("--reversed-z,!--forward-z", options.reversedZ,
                   "device depth 1 at the near plane (default: a model yes, a scene no)");
  command.add_flag("--infinite-far", options.infiniteFar, "no far plane (perspective only)");
  command.add_flag("--view-normals", options.viewNormals, "normals in view instead of world space");
  const std::map<std::string, PellucidDepthEncoding> encodings = {{"viewz", PELLUCID_DEPTH_VIEW_Z},
                                                                  {"device", PELLUCID_DEPTH_DEVICE}};
  command.add_option("--depth", options.depth, "viewz or device (default: a model device, a scene viewz)")
      ->transform(CLI::CheckedTransformer(encodings, CLI::ignore_case));
  std::map<std::string, PellucidDepthEncoding> shadowEncodings = encodings;
  shadowEncodings["distance"] = PELLUCID_DEPTH_DISTANCE;
  command
      .add_option("--shadow-depth", options.shadowDepth,
                  "viewz, device or distance (default: a model device, a scene viewz)")
      ->transform(CLI::CheckedTransformer(shadowEncodings, CLI::ignore_case));
  command.add_option("--shadow-size", options.shadowSize,
                     "texels across a shadow map; 0: none (default: a model 1024, a scene 512)");
  command
      .add_option(
          "--light", options.lights,
          std::string("of a scene: directional, point or spot; of a model, repeatable: ") + kLightSyntax)
      ->take_all();
}

void addTurntableOptions(CLI::App& command, Options& options) {
  const char* const group = "Turntables";
  const CLI::Range turns(1, 1000000);
  command
      .add_option("--turntable", options.turntable,
                  "frames in which the model turns once about the vertical; -o is name.####.exr")
      ->check(turns)
      ->group(group);
  command.add_option("--light-turntable", options.lightTurntable, "frames in which the lights turn once")
      ->check(turns)
      ->group(group);
  command.add_flag("--orbit", options.orbit, "the camera goes round the model instead")->group(group);
  command
      .add_option("--frames", options.frames,
                  "only these frames: FIRST-LAST or a list like 1-10,20 (default: one turn)")
      ->group(group);
}

void addModelOptions(CLI::App& command, Options& options) {
  GltfCapture& gltf = options.gltf;
  const char* const group = kModelGroup;
  command.add_option("model", gltf.model, "glTF file, .glb or .gltf");
  command.add_option("--material", options.presets, "NAME=PRESET, repeatable; NAME * means all others")
      ->take_all()
      ->group(group);
  command.add_option("--unit", options.unit, "mm, cm, m or meters: the length of the file's unit")
      ->capture_default_str()
      ->group(group);
  command.add_option("--camera", gltf.camera, "name of one of the file's cameras, or auto")->group(group);
  command.add_option("--view", options.view, "X,Y,Z: where the auto camera stands from the center")
      ->group(group);
  command.add_option("--fov", gltf.verticalFov, "vertical field of view of the auto camera, degrees")
      ->check(CLI::Range(1.0, 170.0))
      ->capture_default_str()
      ->group(group);
  const std::map<std::string, BackFace> faces = {{"nearest", BackFace::Nearest},
                                                 {"farthest", BackFace::Farthest}};
  command.add_option("--back", gltf.raster.backFace, "which back face behind the front: nearest or farthest")
      ->transform(CLI::CheckedTransformer(faces, CLI::ignore_case))
      ->group(group);
  command
      .add_option("--point-maps", options.pointMaps,
                  "shadow maps of a point light: 1, 6 or auto, 6 where 1 cannot see the whole model")
      ->check(CLI::IsMember({"auto", "1", "6"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--device", gltf.device, "part of the Vulkan device's name; default: the fastest kind")
      ->group(group);
}

void addSceneOptions(CLI::App& command, Options& options) {
  const char* const group = kSceneGroup;
  command
      .add_option("--procedural", options.scene.name, "name of the scene; list: print all with their options")
      ->group(group);
  command.add_option("--seed", options.scene.seed, "of scenes that scatter things")
      ->capture_default_str()
      ->group(group);
  command.add_option("--set", options.set, "key=value, repeatable: an option of the scene")
      ->take_all()
      ->group(group);
}

}  // namespace

void addCaptureCommand(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("capture", "Make a capture of a glTF model or a procedural scene");
  addCommonOptions(*command, *options);
  addTurntableOptions(*command, *options);
  addModelOptions(*command, *options);
  addSceneOptions(*command, *options);
  command->callback([options, command] { capture(*command, *options); });
}

}  // namespace pellucid::harness
