// `pellucid measure-dots`: a table of minimum dots, from pictures of the object lit from all around.
#include "cli/measure_dots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "capture/material.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/numbers.h"
#include "cli/settings.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "raster/framing.h"
#include "raster/raster.h"
#include "replay/replay.h"
#include "scene/scene.h"
#include "scene/vector.h"

namespace pellucid::harness {
namespace {

struct Axes {
  glm::dvec3 side, up, front;
};

Axes axesOf(const DotTable& table) {
  const glm::dvec3 up = glm::normalize(toGlm(table.up));
  const glm::dvec3 side = glm::normalize(glm::cross(up, toGlm(table.face)));
  return {side, up, glm::cross(side, up)};
}

}  // namespace

std::vector<Vector3> lightDirections(const DotTable& table) {
  const Axes axes = axesOf(table);
  std::vector<Vector3> directions;
  for (int i = 0; i < table.entries; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / table.entries;
    directions.push_back(fromGlm(std::sin(azimuth) * axes.side + std::cos(azimuth) * axes.front));
  }
  return directions;
}

std::vector<double> measureMinimumDots(const DotTable& table, const Swing& swing,
                                       const LightThrough& through) {
  const Axes axes = axesOf(table);
  const auto dotAt = [&](int step) {
    return step == 0 ? 0 : std::cos(std::numbers::pi / 2 * (1 + static_cast<double>(step) / swing.steps));
  };
  std::vector<std::vector<double>> light;  // by entry and step
  double most = 0;
  for (const Vector3& direction : lightDirections(table)) {
    const glm::dvec3 toLight = toGlm(direction);
    const glm::dvec3 sideways = glm::cross(axes.up, toLight);  // the eye swings about the up axis
    light.emplace_back();
    for (int step = 0; step <= swing.steps; ++step) {
      const double dot = dotAt(step);
      const glm::dvec3 away = std::sqrt(std::max(0.0, 1 - dot * dot)) * sideways;
      const double one = through(direction, fromGlm(dot * toLight + away));
      const double other = step < swing.steps ? through(direction, fromGlm(dot * toLight - away)) : one;
      light.back().push_back(std::max(one, other));
      most = std::max(most, light.back().back());
    }
  }
  const double enough = swing.threshold * most;
  std::vector<double> dots;
  for (const std::vector<double>& steps : light) {
    const auto first = std::find_if(steps.begin(), steps.end(), [&](double v) { return v > enough; });
    const int step = static_cast<int>(first - steps.begin());
    double dot = -1;
    if (step == 0) {
      dot = 0;
    } else if (first != steps.end()) {
      const double from = dotAt(step - 1), to = dotAt(step), before = *(first - 1);
      dot = from + (to - from) * (enough - before) / (*first - before);
    }
    dots.push_back(std::round(dot * 1e4) / 1e4 + 0.0);  // no minus zero
  }
  return dots;
}

namespace {

struct Options {
  CaptureOptions scene;
  std::string output, face = "0,0,1", up = "0,1,0";
  DotTable table;
  Swing swing;
  SettingsOptions settings;
};

// The object seen and lit from two directions.
using View = std::function<Capture(const Vector3& toLight, const Vector3& toEye)>;

struct Object {
  Vector3 center;
  View view;
};

DotTable tableOf(const Options& options) {
  DotTable table = options.table;
  table.face = parseNumbers<3>("--face", options.face, "X,Y,Z");
  table.up = parseNumbers<3>("--up", options.up, "X,Y,Z");
  const glm::dvec3 face = toGlm(table.face), up = toGlm(table.up);
  if (!(glm::length(glm::cross(up, face)) > 1e-6 * glm::length(face) * glm::length(up)))
    throw UsageError("--face: \"" + options.face + "\" is along --up \"" + options.up + "\"");
  return table;
}

ReplaySettings settingsOf(const Options& options) {
  ReplaySettings settings = options.settings.parse();
  const ReplaySettings defaults;
  if (settings.features != defaults.features || settings.outputFormat != defaults.outputFormat ||
      settings.aliasOutput || settings.renderRect != defaults.renderRect ||
      settings.reuse != defaults.reuse || settings.debugView != defaults.debugView)
    throw UsageError(
        "--set: features, format, alias, rect, reuse and --debug are not of the light that comes through");
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.translucency.gatherSamples = 0;  // gathered light knows no minimum dot
  settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  return settings;
}

// Every view ray must have the same cosine with the light: cameras are orthographic.
Object proceduralObject(const Options& options) {
  SceneParameters scene = procedural(options.scene);
  scene.orthographic = true;
  return {sceneCenter(scene), [scene](const Vector3& toLight, const Vector3& toEye) {
            SceneParameters aimed = scene;
            aimed.aim = Aim{toEye, toLight};
            return makeScene(aimed);
          }};
}

Object modelObject(const Options& options, Device& device) {
  const auto scene = std::make_shared<CaptureModel>(captureModel(options.scene));
  warn(scene->warnings);
  return {boundsOf(scene->model).center, [scene, &device](const Vector3& toLight, const Vector3& toEye) {
            Light light;
            for (std::size_t i = 0; i < 3; ++i) light.direction[i] = -toLight[i];
            scene->model.lights = {light};
            return rasterize(device, scene->model, frameModel(scene->model, toEye, 0.5, 1, true), scene->raster)
                .capture;
          }};
}

// Mean over the material's pixels and the channels.
double lightThrough(Capture& capture, const std::vector<PellucidMaterial>& materials,
                    const ReplaySettings& settings, Replayer& replayer) {
  // Without light of its own the frame is what came through.
  std::fill(capture.irradiance.data.begin(), capture.irradiance.data.end(), 0.0f);
  capture.albedo = {};
  const Image out = replayer.run(capture, materials, settings).output;
  double sum = 0;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < capture.material.size(); ++i) {
    if (capture.material[i] == 0) continue;
    ++pixels;
    for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(out.data[4 * i + c]) / 3;
  }
  return pixels > 0 ? sum / static_cast<double>(pixels) : 0;
}

// Lights, cameras and skies are what is swept, or not of the light that comes through.
void requireSwept(const Command& command, const Options& options) {
  const std::set<std::string> mine = {"--light", "--camera", "--view", "--fov", "--projection", "--environment"};
  for (const GivenOption& option : command.given())
    if (mine.count(option.name) > 0)
      throw UsageError(option.name + ": measure-dots has lights, cameras and surroundings of its own");
  const auto [width, height] = parseSize("--size", options.scene.size);
  if (width != height) throw UsageError("--size: \"" + options.scene.size + "\" is not a square");
}

void measure(const Command& command, const Options& options) {
  const bool isScene = isProcedural(command, options.scene);
  requireSwept(command, options);
  const DotTable table = tableOf(options);
  const ReplaySettings settings = settingsOf(options);
  Device device({options.scene.device, false});
  Replayer replayer(device);
  const Object object = isScene ? proceduralObject(options) : modelObject(options, device);
  const auto entries = static_cast<std::size_t>(table.entries);
  Progress progress("measuring", entries * (2 * static_cast<std::size_t>(options.swing.steps) + 1));
  std::vector<PellucidMaterial> materials;  // of every view
  const std::vector<double> dots =
      measureMinimumDots(table, options.swing, [&](const Vector3& toLight, const Vector3& toEye) {
        Capture capture = object.view(toLight, toEye);
        if (materials.empty()) {
          if (isScene) setIor(capture.materials, options.scene);
          materials = compileMaterials(capture);
        }
        const double through = lightThrough(capture, materials, settings, replayer);
        progress.advance();
        return through;
      });
  const nlohmann::ordered_json json = {{"angle", "minimum-dot-azimuth"},
                                       {"face", table.face},
                                       {"up", table.up},
                                       {"center", object.center},
                                       {"minimum-dots", dots}};
  if (options.output.empty()) {
    std::cout << json.dump(2) << "\n";
    return;
  }
  writeWholeText(options.output, json.dump(2) + "\n");
  const auto [least, most] = std::minmax_element(dots.begin(), dots.end());
  std::printf("wrote %s: %zu entries from %g to %g; replay --set @%s uses it\n", options.output.c_str(),
              entries, *least, *most, options.output.c_str());
}

}  // namespace

void addMeasureDotsCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  options->scene.size = "64x64";
  options->scene.shadowSize = 128;
  const Command command = app.subcommand(
      "measure-dots", "Measure how far behind an object lights must be before they come through (a table)");
  command.option("-o,--output", options->output, "JSON for --set @FILE; default: standard output");
  command.option("--entries", options->table.entries, "lights around --up").range(1, 360);
  command.option("--face", options->face, "X,Y,Z the object looks along, world");
  command.option("--up", options->up, "X,Y,Z of the object, world");
  command.option("--steps", options->swing.steps, "of the camera over its quarter turn").range(1, 900);
  command
      .option("--threshold", options->swing.threshold,
              "what counts as light: this part of the most that any view shows")
      .range(0.0, 0.99);
  addCaptureOptions(command, options->scene, SceneUse::Replay);
  options->settings.addTo(command);
  command.run([options, command] { measure(command, *options); });
}

}  // namespace pellucid::harness
