#include <CLI/CLI.hpp>
#include <charconv>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>

#include "capture/write.h"
#include "cli/commands.h"
#include "common/error.h"
#include "scene/scene.h"

namespace pellucid::harness {

namespace {

struct Options {
  SceneParameters scene;
  std::string output, size = "512x512";
  std::vector<std::string> set;
};

template <class T>
T parseNumber(const std::string& what, const std::string& text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) throw UsageError(what + ": \"" + text + "\" is not a number");
  return value;
}

void printScenes() {
  for (const SceneInfo& scene : listScenes()) {
    std::cout << scene.name << ": " << scene.description << "\n";
    for (const SceneOption& option : scene.options) {
      std::cout << "    " << std::left << std::setw(13) << option.name << option.description << " (default "
                << option.defaultValue << ", " << option.minimum << " .. " << option.maximum << ")\n";
    }
  }
}

void capture(const Options& options) {
  if (options.scene.name == "list") return printScenes();
  if (options.output.empty()) throw UsageError("capture: -o is required");

  SceneParameters scene = options.scene;
  const std::size_t cross = options.size.find('x');
  if (cross == std::string::npos) throw UsageError("--size: \"" + options.size + "\" is not WIDTHxHEIGHT");
  scene.width = parseNumber<int>("--size", options.size.substr(0, cross));
  scene.height = parseNumber<int>("--size", options.size.substr(cross + 1));
  for (const std::string& assignment : options.set) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw UsageError("--set: \"" + assignment + "\" is not key=value");
    const std::string key = assignment.substr(0, equals);
    scene.options[key] = parseNumber<double>("--set " + key, assignment.substr(equals + 1));
  }
  writeCapture(makeScene(scene), options.output);
}

}  // namespace

void addCaptureCommand(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  SceneParameters& scene = options->scene;
  CLI::App* command = app.add_subcommand("capture", "Make a capture of a procedural scene");
  command->add_option("--procedural", scene.name, "name of the scene; list: print all with their options")
      ->required();
  command->add_option("-o,--output", options->output, "EXR to write, the manifest embedded");
  command->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  command->add_option("--seed", scene.seed, "of scenes that scatter things")->capture_default_str();
  command->add_option("--set", options->set, "key=value, repeatable: an option of the scene")->take_all();

  const auto orthographic = std::make_shared<bool>(false);
  const std::map<std::string, bool> projections = {{"perspective", false}, {"orthographic", true}};
  CLI::Option* projection =
      command->add_option("--projection", *orthographic, "perspective or orthographic (default: the scene's)")
          ->transform(CLI::CheckedTransformer(projections, CLI::ignore_case));
  command->add_flag("--reversed-z", scene.reversedZ, "device depth 1 at the near plane");
  command->add_flag("--infinite-far", scene.infiniteFar, "no far plane (perspective only)");
  command->add_flag("--view-normals", scene.normalsInViewSpace, "normals in view instead of world space");

  const std::map<std::string, PellucidDepthEncoding> encodings = {{"viewz", PELLUCID_DEPTH_VIEW_Z},
                                                                  {"device", PELLUCID_DEPTH_DEVICE}};
  command->add_option("--depth", scene.depthEncoding, "viewz (default) or device")
      ->transform(CLI::CheckedTransformer(encodings, CLI::ignore_case));
  std::map<std::string, PellucidDepthEncoding> shadowEncodings = encodings;
  shadowEncodings["distance"] = PELLUCID_DEPTH_DISTANCE;
  command->add_option("--shadow-depth", scene.shadowEncoding, "viewz (default), device or distance")
      ->transform(CLI::CheckedTransformer(shadowEncodings, CLI::ignore_case));
  command->add_option("--shadow-size", scene.shadowSize, "texels across a shadow map; 0: none")
      ->capture_default_str();

  const auto light = std::make_shared<PellucidLightType>(PELLUCID_LIGHT_DIRECTIONAL);
  const std::map<std::string, PellucidLightType> lights = {{"directional", PELLUCID_LIGHT_DIRECTIONAL},
                                                           {"point", PELLUCID_LIGHT_POINT},
                                                           {"spot", PELLUCID_LIGHT_SPOT}};
  CLI::Option* lightType =
      command->add_option("--light", *light, "directional, point or spot (default: the scene's)")
          ->transform(CLI::CheckedTransformer(lights, CLI::ignore_case));

  command->callback([=] {
    if (*projection) options->scene.orthographic = *orthographic;
    if (*lightType) options->scene.lightType = *light;
    capture(*options);
  });
}

}  // namespace pellucid::harness
