// The options that say what to capture: those of `pellucid capture`, and of every other command that takes a
// scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "gltf/gltf.h"
#include "raster/raster.h"
#include "scene/environment.h"
#include "scene/scene.h"

namespace pellucid::harness {

namespace reference {
class TraceScene;
}

inline constexpr const char* kBackLight = "back";
inline constexpr const char* kFrontLight = "front";
inline constexpr const char* kLightSyntax =
    "directional:X,Y,Z[:E], point:X,Y,Z[:I], spot:X,Y,Z[:I], sphere:X,Y,Z:RADIUS[:I], back or front";

// As given. Options of both kinds of scene stand before the two; absent ones have each kind's own default.
struct CaptureOptions {
  std::string size, device;  // "": of a model whose camera has an aspect 512 high, else 512x512
  bool infiniteFar = false;
  std::optional<bool> reversedZ, orthographic;
  std::optional<PellucidDepthEncoding> depth, shadowDepth;
  std::optional<int> shadowSize;
  std::vector<std::string> lights;  // of a model: kLightSyntax; empty: the file's, and "back" without any
  std::vector<std::string> presets;
  std::optional<double> ior;  // of all materials
  std::string environment;    // "": none

  SceneParameters scene;
  std::vector<std::string> set;

  std::string model, unit = "m", view;
  GltfOptions gltf;
  RasterOptions raster;
  double verticalFov = 30;  // of the auto camera, degrees
  bool fillHoles = false;
  std::string shadowDepthBias, jitter;  // "": none
  bool shadowAtlas = false, shadowArray = false;
};

// A light of the command line. X,Y,Z: direction of travel of a directional light, else the position in the
// file's world; spots look at the model's center. E: irradiance at normal incidence, I: intensity, both of
// KHR_lights_punctual; by default 1 arrives at the model's center. A sphere is a point light with a radius.
// "back" and "front": directional, from above, towards `camera` and away from it. Throws UsageError.
Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera);

// Meters of "mm", "cm", "m" or a number. Throws UsageError.
double parseUnit(const std::string& text);

// A glTF file made ready for rasterize(): its lights are those to capture with.
struct CaptureModel {
  Model model;
  ModelCamera camera;
  RasterOptions raster;
  std::vector<std::string> notes, warnings;  // sentences for a person
  std::vector<std::string> materialNames;    // as --material takes them
};

// Prints sentences on stderr.
void warn(const std::vector<std::string>& warnings);

// Prints notes and warnings on stderr.
void say(const CaptureModel& model);

// Throws InputError, which names --material, for a model without a translucent material: its capture would
// have none.
void requireTranslucent(const CaptureModel& model);

// Commands that take a scene: those that capture it, and those that replay it too, whose --set is the
// replay's: the scene's is --scene-set, and --device is of procedural scenes as well.
enum class SceneUse { Capture, Replay };

// Adds all of them to a command, but for its output.
void addCaptureOptions(const Command& command, CaptureOptions& options, SceneUse use = SceneUse::Capture);

// True when they name a procedural scene; else they name a model. Throws UsageError when they name both or
// neither, and for an option of the other kind: one without effect is a mistake of who gave it.
bool isProcedural(const Command& command, const CaptureOptions& options);

// Throws UsageError.
SceneParameters procedural(const CaptureOptions& options);

// Applies --ior to the materials of a procedural scene; a glTF file is read with it. Throws InputError.
void setIor(std::vector<MaterialSource>& materials, const CaptureOptions& options);

inline constexpr const char* kEnvironmentSyntax = "uniform:R,G,B or gradient:R,G,B:R,G,B (from +y, from -y)";

// Throws UsageError.
std::optional<Environment> environment(const CaptureOptions& options);

// Reads the file and gives its bodies numbers. `turns` (radians): of the turntable's cameras, all of which
// the auto camera fits. lightsOfNone: kLightSyntax, of a file without lights. Throws UsageError and
// InputError.
CaptureModel captureModel(const CaptureOptions& options, const std::vector<double>& turns = {0},
                          const std::vector<std::string>& lightsOfNone = {kBackLight});

// The capture of a procedural scene with its --ior and --environment. Throws as makeScene() does.
Capture captureScene(const SceneParameters& scene, const CaptureOptions& options);

// The capture that rasterize() draws, and on top of it the irradiance of the environment and of lights that
// have a radius, traced by rays.
RasterResult captureScene(Device& device, const Model& model, const ModelCamera& camera,
                          const RasterOptions& raster, const std::optional<Environment>& environment);

// Adds that irradiance to a capture of the traced scene; nothing where it has neither.
void addTracedLight(Capture& capture, const reference::TraceScene& scene,
                    const std::optional<Environment>& environment);

}  // namespace pellucid::harness
