// `pellucid capture`: a capture of a procedural scene, or of a glTF file.
#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <set>

#include "capture/material.h"
#include "capture/write.h"
#include "cli/capture_checks.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "raster/bodies.h"
#include "raster/framing.h"
#include "reference/camera_motion.h"
#include "scene/scene.h"
#include "scene/turn.h"

namespace pellucid::harness {

namespace {

struct Turntable {
  int turntable = 0, lightTurntable = 0;  // frames of one turn; 0: none
  bool orbit = false;
  std::string frames;
};

struct Options {
  CaptureOptions scene;
  Turntable turntable;
  std::string output;
};

// One capture to write, of the still scene or of a turntable.
struct CaptureFrame {
  std::filesystem::path output;
  Turn turn;
  double step = 0;  // the camera's turn since the frame before, radians
};

void printScenes() {
  for (const SceneInfo& scene : listScenes()) {
    std::cout << scene.name << ": " << scene.description << "\n";
    for (const SceneOption& option : scene.options) {
      std::cout << "    " << std::left << std::setw(13) << option.name << option.description << " (default "
                << option.defaultValue << ", " << option.minimum << " .. " << option.maximum << ")\n";
    }
  }
}

// The model turns before a fixed camera, or with --orbit the camera goes round the model, and the lights turn
// at their own speed. As captures keep the model where it is, camera and lights turn back by its angle.
Turn turnAt(const Turntable& options, int frame) {
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

std::vector<CaptureFrame> framesOf(const Turntable& options, const std::string& file) {
  const int turns = options.turntable > 0 ? options.turntable : options.lightTurntable;
  if (turns == 0) {
    if (options.orbit) throw UsageError("--orbit: needs --turntable");
    if (!options.frames.empty()) throw UsageError("--frames: needs --turntable or --light-turntable");
    return {{file, {}}};
  }
  if (options.orbit && options.turntable == 0) throw UsageError("--orbit: needs --turntable");
  const FramePattern output("-o", file);
  std::vector<CaptureFrame> frames;
  for (const int frame :
       parseFrames(options.frames.empty() ? "1-" + std::to_string(turns) : options.frames)) {
    if (frame < 1) throw UsageError("--frames: a turntable begins at frame 1");
    const Turn turn = turnAt(options, frame), before = turnAt(options, frame - 1);
    frames.push_back({output(frame), turn, turn.camera.value_or(0) - before.camera.value_or(0)});
  }
  return frames;
}

// A turntable warns of its first frame alone: the body's size differs in each frame, and so would each
// warning.
void warnOfThinBodies(const Capture& capture, const std::filesystem::path& file) {
  for (const std::string& sentence : thinBodies(capture, compileMaterials(capture)))
    warn({file.string() + ": " + sentence});
}

// Gives the capture the motion since the turntable's frame before, which need not be drawn.
void addMotion(const CaptureFrame& frame, const Vector3& center, Capture& capture) {
  const Matrix before = turnedView(capture.viewFromWorld, center, -frame.step);
  capture.motion = reference::CameraMotion(capture, capture.clipFromView, before).image();
}

void captureProcedural(const Options& options) {
  SceneParameters scene = procedural(options.scene);
  const std::vector<CaptureFrame> frames = framesOf(options.turntable, options.output);
  Progress progress("capturing", frames.size());
  for (const CaptureFrame& frame : frames) {
    scene.turn = frame.turn;
    Capture capture = captureScene(scene, options.scene);
    if (frame.step != 0) addMotion(frame, sceneCenter(scene), capture);
    if (&frame == &frames.front()) warnOfThinBodies(capture, frame.output);
    writeWhole(frame.output, [&](const auto& file) { writeCapture(capture, file); });
    progress.advance();
  }
}

void captureGltf(const Options& options) {
  const std::vector<CaptureFrame> frames = framesOf(options.turntable, options.output);
  // A degree apart is enough for any turntable: the auto camera leaves a margin.
  const int turns = std::min(options.turntable.turntable, 360);
  std::vector<double> angles = {0};
  for (int i = 1; i < turns; ++i) angles.push_back(2 * std::numbers::pi * i / turns);
  CaptureModel scene = captureModel(options.scene, angles);
  for (std::string& sentence : opaqueInside(scene.model)) scene.warnings.push_back(std::move(sentence));
  say(scene);
  requireTranslucent(scene);

  const std::optional<Environment> sky = environment(options.scene);
  Device device({options.scene.device, false});
  const Vector3 center = boundsOf(scene.model).center;
  const std::vector<Light> still = scene.model.lights;
  std::set<std::string> said;  // a turntable's frames have most warnings in common
  Progress progress("capturing", frames.size());
  for (const CaptureFrame& frame : frames) {
    ModelCamera turned = scene.camera;
    turned.viewFromWorld = turnedView(scene.camera.viewFromWorld, center, frame.turn.camera.value_or(0));
    for (std::size_t i = 0; i < still.size(); ++i)
      scene.model.lights[i] = turnedLight(still[i], center, frame.turn.lights.value_or(0));
    RasterResult result = captureScene(device, scene.model, turned, scene.raster, sky);
    for (const std::string& warning : result.warnings)
      if (said.insert(warning).second) warn({frame.output.string() + ": " + warning});
    if (frame.step != 0) addMotion(frame, center, result.capture);
    if (&frame == &frames.front()) warnOfThinBodies(result.capture, frame.output);
    writeWhole(frame.output, [&](const auto& file) { writeCapture(result.capture, file); });
    progress.advance();
  }
  std::printf("%s: %zu triangles, %zu materials, camera %s, %zu lights on %s\nwrote %s%s\n",
              options.scene.model.c_str(), scene.model.indices.size() / 3, scene.model.materials.size(),
              scene.camera.name.c_str(), scene.model.lights.size(), device.description().c_str(),
              frames.front().output.c_str(),
              frames.size() > 1 ? (" .. " + frames.back().output.string()).c_str() : "");
}

void capture(const Command& command, const Options& options) {
  if (options.scene.scene.name == "list") return printScenes();
  const bool procedural = isProcedural(command, options.scene);
  if (options.output.empty()) throw UsageError("capture: -o is required");
  requireExr("-o", options.output);
  return procedural ? captureProcedural(options) : captureGltf(options);
}

void addTurntableOptions(const Command& command, Turntable& options) {
  const Command turns = command.group("Turntables");
  turns
      .option("--turntable", options.turntable,
              "frames in which the model turns once about the vertical; -o is name.####.exr")
      .range(1, 1000000);
  turns.option("--light-turntable", options.lightTurntable, "frames in which the lights turn once")
      .range(1, 1000000);
  turns.flag("--orbit", options.orbit, "the camera goes round the model instead");
  turns.option("--frames", options.frames,
               "only these frames: FIRST-LAST or a list like 1-10,20 (default: one turn)");
}

}  // namespace

void addCaptureCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand("capture", "Make a capture of a glTF model or a procedural scene");
  command.option("-o,--output", options->output, "EXR to write, the manifest embedded");
  addCaptureOptions(command, options->scene);
  addTurntableOptions(command, options->turntable);
  command.run([options, command] { capture(command, *options); });
}

}  // namespace pellucid::harness
