// `pellucid view`: the interactive application.

#include "cli/commands.h"
#include "common/error.h"

#ifndef PELLUCID_HAS_VIEWER

namespace pellucid::harness {

void addViewCommand(const Command& app) {
  const Command command = app.subcommand("view", "Look at a scene and change it (left out of this build)");
  command.allowAnything();
  command.run([] {
    throw UsageError(
        "view: this build has no viewer, as libglfw3-dev or libimgui-dev was missing; install them and "
        "configure again");
  });
}

}  // namespace pellucid::harness

#else

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "capture/read.h"
#include "cli/capture_options.h"
#include "cli/numbers.h"
#include "cli/settings.h"
#include "scene/model.h"
#include "view/application.h"

namespace pellucid::harness {

namespace {

struct Options {
  CaptureOptions scene;
  SettingsOptions settings;
  std::string windowSize = "1280x800";
  bool noWindow = false, validate = false;
  int frames = 0;
  std::string screenshot, save;
  float exposure = 0;
};

// Options of the viewer and of the replay; all others are options of the scene.
const std::set<std::string> kNotOfTheScene = {"--set",         "--mode",      "--debug",    "--device",
                                              "--window-size", "--no-window", "--validate", "--frames",
                                              "--screenshot",  "--exposure",  "--save",     "--help"};

std::function<std::unique_ptr<Source>(Device&)> opener(const Command& command, const CaptureOptions& scene) {
  if (!scene.environment.empty())
    throw UsageError("--environment: is traced by rays, which takes too long; make a capture and view that");
  if (!scene.model.empty() && isCaptureFile(scene.model)) {
    for (const GivenOption& option : command.given())
      if (!option.positional && kNotOfTheScene.count(option.name) == 0)
        throw UsageError(option.name + ": " + scene.model + " is a capture, whose scene is what it holds");
    return [path = scene.model](Device&) { return captureSource(readCapture(path)); };
  }
  if (isProcedural(command, scene))
    return [scene](Device&) {
      const SceneParameters parameters = procedural(scene);
      std::vector<MaterialSource> materials = sceneModel(parameters).materials;
      setIor(materials, scene);
      return sceneSource(parameters, materials);
    };
  return [scene](Device& device) {
    // A light behind the model and one in front: light that comes through beside lit surfaces.
    CaptureModel model = captureModel(scene, {0}, {kBackLight, kFrontLight});
    say(model);
    return modelSource(device, std::move(model.model), model.camera, model.raster);
  };
}

ReplaySettings parsed(const SettingsOptions& options) {
  const ReplaySettings settings = options.parse();
  if (settings.reuse == PELLUCID_REUSE_ACCUMULATE)
    throw UsageError("--set reuse=accumulate: needs motion vectors, which the viewer does not draw");
  return settings;
}

SceneToView sceneOf(const Command& command, const Options& options) {
  const ReplaySettings settings = parsed(options.settings);
  return {opener(command, options.scene), [settings, exposure = options.exposure](ViewState& state) {
            state.settings = settings;
            if (exposure > 0) state.display.exposure = exposure;
            if (settings.debugView != PELLUCID_DEBUG_NONE) state.display.shown = Shown::Debug;
          }};
}

void setWindowSize(const std::string& text, ApplicationOptions& options) {
  const auto [width, height] = parseSize("--window-size", text);
  options.width = width;
  options.height = height;
  for (const int side : {options.width, options.height})
    if (side < kSmallestWindow || side > kLargestSide)
      throw UsageError("--window-size: " + std::to_string(side) + " is outside " +
                       std::to_string(kSmallestWindow) + " .. " + std::to_string(kLargestSide));
}

void view(const Command& command, const Options& options) {
  if (options.noWindow && options.frames == 0) throw UsageError("--no-window: needs --frames");
  ApplicationOptions application;
  application.device = options.scene.device;
  application.validation = options.validate;
  application.window = !options.noWindow;
  setWindowSize(options.windowSize, application);
  application.frames = options.frames;
  application.screenshot = options.screenshot;
  application.save = options.save;
  application.settingsText = settingsJson;
  application.scene = sceneOf(command, options);
  const ApplicationReport report = runApplication(application);
  std::printf("%s\n%d frames of the screen, %llu of the module\n", report.device.c_str(), report.frames,
              static_cast<unsigned long long>(report.recorded));
  for (const std::string& file : report.saved) std::printf("wrote %s\n", file.c_str());
}

}  // namespace

void addViewCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand("view", "Look at a model, a scene or a capture, and change it");
  addCaptureOptions(command, options->scene, SceneUse::Replay);
  command.describe("model", "glTF file (.glb, .gltf) or capture (.exr, .json)");
  options->settings.addTo(command);
  command.option("--window-size", options->windowSize, "WIDTHxHEIGHT in pixels");
  command
      .option("--frames", options->frames,
              "of the screen, after which it ends; default: when the window is closed")
      .range(1, 1000000);
  command.flag("--no-window", options->noWindow, "draws into an image: needs no display");
  command.option("--screenshot", options->screenshot, "PNG of the last frame of the screen");
  command.option("--save", options->save,
                 "NAME.exr: at the end the capture, with settings, result and picture beside it");
  command.option("--exposure", options->exposure, "factor; default: from the first picture").positive();
  command.flag("--validate", options->validate,
               "with the Vulkan validation layers, whose messages are an error");
  command.run([options, command] { view(command, *options); });
}

}  // namespace pellucid::harness

#endif
