// `pellucid flicker`: what changes in a result when the camera moves by whole pixels or lights turn a little.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "capture/material.h"
#include "capture/read.h"
#include "cli/capture_options.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/limits.h"
#include "cli/numbers.h"
#include "cli/settings.h"
#include "common/compare.h"
#include "common/error.h"
#include "common/png.h"
#include "common/progress.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "raster/camera_path.h"
#include "raster/framing.h"
#include "replay/replay.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefinitions =
    "A row compares two frames that should look alike, by the difference between them, R G B.\n"
    "rel_rmse: RMS of the difference over the RMS of the still frame. p999, worst: 99.9th percentile and\n"
    "maximum of the difference over the mean of the still frame's 5x5 pixels around.\n"
    "moved: the view lies some pixels to the side.\n"
    "lights turned: the lights turn about the vertical through the scene's center. The difference is the\n"
    "change less its mean over 5x5 pixels, as diffused light changes evenly; hard shadows' edges count.\n"
    "path: frame by frame, each pixel with its place in the frame before; mean over the frames, and the\n"
    "largest of the rest. The difference is less its mean over 5x5 pixels.\n"
    "irradiance: the input is compared likewise, before any diffusion.\n"
    "spots: regions of up to 5x5 pixels that stand out of their surface, as compare counts them, that only "
    "the\n"
    "frame of turned lights has (appear), or only the still one (vanish).\n"
    "docs/accuracy.md has the definitions.\n";

const std::vector<LimitKind> kLimitKinds = {{"rel_rmse"}, {"p999"}, {"worst"}, {"spots"}};

struct Options {
  CaptureOptions scene;
  SettingsOptions settings;
  std::string pixels = "1,2,3,5";
  double lightDegrees = 0.5;
  std::string paths;  // "": none
  int frames = 24;
  std::string picture;  // "": none
  std::vector<std::string> limits;
  bool json = false;
};

// A frame, the same with turned lights where there are any to turn, and the model of both, if it is one.
struct Frames {
  Capture still;
  std::optional<Capture> turned;
  std::optional<CaptureModel> scene;
};

struct Row {
  std::string change;
  Flicker flicker;
  std::optional<SpotFlicker> spots;  // of results whose lights turned
  std::vector<Flicker> steps;        // of a path, frame by frame
};

std::vector<int> parsePixels(const std::string& text) {
  std::vector<int> pixels;
  for (const std::string& part : split(text, ',')) {
    pixels.push_back(parseNumber<int>("--pixels", part));
    if (pixels.back() == 0 || std::abs(pixels.back()) > 1024)
      throw UsageError("--pixels: \"" + part + "\" is not a number of pixels from 1 to 1024, or -1024 to -1");
  }
  return pixels;
}

Frames proceduralFrames(const Options& options) {
  SceneParameters scene = procedural(options.scene);
  Frames frames{captureScene(scene, options.scene), std::nullopt};
  if (options.lightDegrees != 0 && !frames.still.lights.empty()) {
    scene.turn.lights = options.lightDegrees * std::numbers::pi / 180;
    frames.turned = captureScene(scene, options.scene);
  }
  return frames;
}

Frames modelFrames(const Options& options, Device& device) {
  CaptureModel scene = captureModel(options.scene);
  requireTranslucent(scene);
  const std::optional<Environment> sky = environment(options.scene);
  const RasterResult still = captureScene(device, scene.model, scene.camera, scene.raster, sky);
  scene.warnings.insert(scene.warnings.end(), still.warnings.begin(), still.warnings.end());
  say(scene);
  Frames frames{still.capture, std::nullopt};
  if (options.lightDegrees != 0 && !scene.model.lights.empty()) {
    const Vector3 center = boundsOf(scene.model).center;
    const std::vector<Light> stillLights = scene.model.lights;
    for (Light& light : scene.model.lights)
      light = turnedLight(light, center, options.lightDegrees * std::numbers::pi / 180);
    frames.turned = captureScene(device, scene.model, scene.camera, scene.raster, sky).capture;
    scene.model.lights = stillLights;
  }
  frames.scene = std::move(scene);
  return frames;
}

// The options of a scene have no meaning for a capture.
void refuseSceneOptions(const Command& command, const std::vector<std::string>& sceneOptions) {
  for (const std::string& option : sceneOptions)
    if (command.isGiven(option) && option != "model" && option != "--device")
      throw UsageError(option + ": needs a model or --procedural, and not a capture");
}

std::vector<Row> measure(const Options& options, const std::vector<int>& pixels, const Frames& frames,
                         const ReplaySettings& settings, Device& device) {
  int rim = 0;
  for (const int k : pixels) rim = std::max(rim, std::abs(k));
  const std::vector<PellucidMaterial> materials = compileMaterials(frames.still);
  const Capture base = movedCapture(frames.still, 0, 0, rim);
  const Mask mask = comparisonMask(base.material, base.irradiance, Subset::All);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end())
    throw InputError(frames.still.name, "material",
                     "is 0 but for a rim of " + std::to_string(rim) + " pixels: there is nothing to compare");

  Replayer replayer(device);
  Progress progress("replaying", pixels.size() + (frames.turned ? 2 : 1));
  const auto run = [&](const Capture& capture) {
    Image image = rgb(replayer.run(capture, materials, settings).output);
    progress.advance();
    return image;
  };
  const Image still = run(base);
  std::vector<Row> rows;
  for (const int k : pixels) {
    const Image moved = run(movedCapture(frames.still, k, 0, rim));
    rows.push_back({"moved by " + std::to_string(k) + (std::abs(k) == 1 ? " pixel" : " pixels"),
                    compareShifted(still, moved, mask, k, 0), std::nullopt});
  }
  if (frames.turned) {
    const Capture turned = movedCapture(*frames.turned, 0, 0, rim);
    const Surfaces surfaces(base);
    char degrees[32];
    std::snprintf(degrees, sizeof degrees, "%g", options.lightDegrees);
    const std::string change = std::string("lights turned by ") + degrees + " degrees";
    const Image after = run(turned);
    const auto spotsOf = [&](const Image& image) { return SpotImage(image, surfaces, mask); };
    rows.push_back(
        {change, compareTurned(still, after, surfaces, mask),
         compareSpots(spotsOf(still), spotsOf(litAlbedo(base)), spotsOf(after), spotsOf(litAlbedo(turned)))});
    rows.push_back({change + ", irradiance",
                    compareTurned(base.irradiance, turned.irradiance, surfaces, mask), std::nullopt});
  }
  return rows;
}

Row rowOf(std::string change, std::vector<Flicker> steps) {
  return {std::move(change), flickerOf(steps), std::nullopt, std::move(steps)};
}

// Frames of a path, and below each how it differs from the frame before.
class PathPicture {
public:
  explicit PathPicture(int frames) : frames_(frames) {}

  bool wants(int frame) const { return frame > 0 && frame * kShown % (frames_ - 1) < kShown; }
  void add(const Image& result, const Image& difference) {
    results_.push_back(result);
    differences_.push_back(difference);
  }
  void write(const std::string& file) {
    std::vector<const Image*> images;
    for (const Image& result : results_) images.push_back(&result);
    const Image top = contactSheet(images, kShown);
    // The 99th percentile is shown as 0.8: a fall by a twentieth of it is black.
    const float scale = autoExposure(top);
    images.clear();
    for (Image& difference : differences_) {
      for (float& value : difference.data) value = 0.2f + 5 * scale * value;
      images.push_back(&difference);
    }
    std::vector<std::uint8_t> rgb = toSrgb(top, scale);
    const Image bottom = contactSheet(images, kShown);
    const std::vector<std::uint8_t> changes = toSrgb(bottom);
    rgb.insert(rgb.end(), changes.begin(), changes.end());
    writePng(file, top.width, top.height + bottom.height, rgb);
  }

private:
  static constexpr int kShown = 4;
  int frames_;
  std::vector<Image> results_, differences_;
};

void measurePaths(const Options& options, const Frames& frames, const ReplaySettings& settings,
                  Device& device, std::vector<Row>& rows) {
  const std::optional<Environment> sky = environment(options.scene);
  const std::vector<PellucidMaterial> materials = compileMaterials(frames.still);
  for (const std::string& name : split(options.paths, ',')) {
    Model model = frames.scene->model;
    const CameraPath path(name, model, frames.scene->camera);
    ReplaySequence sequence(device);
    std::vector<Flicker> results, irradiances;
    PathPicture picture(options.frames);
    PathFlicker flicker;
    Progress progress("path " + name, static_cast<std::size_t>(options.frames));
    for (int frame = 0; frame < options.frames; ++frame) {
      const CameraPath::Pose pose = path.at(frame);
      model.lights = pose.lights;
      Image difference;
      const std::vector<Flicker> step = flicker.next(
          captureScene(device, model, pose.camera, frames.scene->raster, sky).capture, pose.switches,
          [&](const Capture& capture) {
            return std::vector{rgb(sequence.run(capture, materials, settings).output), capture.irradiance};
          },
          &difference);
      if (!step.empty()) {
        results.push_back(step[0]);
        irradiances.push_back(step[1]);
        if (!options.picture.empty() && picture.wants(frame)) picture.add(flicker.images()[0], difference);
      }
      progress.advance();
    }
    rows.push_back(rowOf("path " + name, std::move(results)));
    rows.push_back(rowOf("path " + name + ", irradiance", std::move(irradiances)));
    if (!options.picture.empty()) picture.write(options.picture);
  }
}

Json toJson(const Flicker& flicker) {
  return {{"rel_rmse", flicker.relativeRmse},
          {"p999", flicker.p999},
          {"worst", flicker.worst},
          {"worstPixel", flicker.worstPixel},
          {"pixels", flicker.pixels}};
}

Json toJson(const SpotFlicker& spots) {
  return {
      {"still", spots.still}, {"turned", spots.turned}, {"appear", spots.appear}, {"vanish", spots.vanish}};
}

std::string toMarkdown(const std::vector<Row>& rows) {
  std::string text = "| change | rel_rmse R G B | p999 R G B | worst R G B | worst at x, y |\n|-|-|-|-|-|\n";
  for (const Row& row : rows) {
    char line[256];
    const auto &e = row.flicker.relativeRmse, &p = row.flicker.p999, &w = row.flicker.worst;
    std::snprintf(line, sizeof line, "| %s | %.4f %.4f %.4f | %.3f %.3f %.3f | %.3f %.3f %.3f | %d, %d |\n",
                  row.change.c_str(), e[0], e[1], e[2], p[0], p[1], p[2], w[0], w[1], w[2],
                  row.flicker.worstPixel[0], row.flicker.worstPixel[1]);
    text += line;
  }
  for (const Row& row : rows)
    if (row.spots)
      text += "\nspots, " + row.change + ": " + std::to_string(row.spots->still) + " before, " +
              std::to_string(row.spots->turned) + " after; " + std::to_string(row.spots->appear) +
              " appear, " + std::to_string(row.spots->vanish) + " vanish\n";
  return text;
}

void flicker(const Command& command, const std::vector<std::string>& sceneOptions, const Options& options) {
  const Limits limits(kLimitKinds, options.limits);
  ReplaySettings settings = options.settings.parse();
  if (settings.debugView != PELLUCID_DEBUG_NONE)
    throw UsageError("--debug: flicker compares results and not intermediates");
  const std::vector<int> pixels = parsePixels(options.pixels);
  Device device({options.scene.device, false});
  Frames frames;
  if (isCaptureFile(options.scene.model)) {
    refuseSceneOptions(command, sceneOptions);
    frames.still = readCapture(options.scene.model);
  } else {
    frames = isProcedural(command, options.scene) ? proceduralFrames(options) : modelFrames(options, device);
  }
  const bool follows = settings.reuse == PELLUCID_REUSE_NONE || settings.reuse == PELLUCID_REUSE_ACCUMULATE;
  if (settings.anchor[3] == 0 && follows) settings.anchor = visibleMiddle(frames.still);
  if (!options.paths.empty() && !frames.scene)
    throw UsageError("--path: needs a model, and not a capture or --procedural");
  if (!options.picture.empty() && split(options.paths, ',').size() != 1)
    throw UsageError("--picture: shows one path, and --path has more");
  std::vector<Row> rows = measure(options, pixels, frames, settings, device);
  if (!options.paths.empty()) measurePaths(options, frames, settings, device, rows);
  if (options.json) {
    Json changes = Json::array();
    for (const Row& row : rows) {
      Json change = toJson(row.flicker);
      change["change"] = row.change;
      if (row.spots) change["spots"] = toJson(*row.spots);
      for (const Flicker& step : row.steps) change["steps"].push_back(toJson(step));
      changes.push_back(std::move(change));
    }
    std::cout << Json{{"frame", frames.still.name},
                      {"size", {frames.still.width, frames.still.height}},
                      {"device", device.description()},
                      {"settings", options.settings.text()},
                      {"changes", std::move(changes)}}
                     .dump(2)
              << "\n";
  } else {
    std::cout << frames.still.name << ", " << frames.still.width << "x" << frames.still.height << ", "
              << rows.front().flicker.pixels << " pixels, " << options.settings.text() << ", on "
              << device.description() << "\n\n"
              << toMarkdown(rows) << "\n"
              << kDefinitions;
  }
  std::vector<Measured> values;
  for (const Row& row : rows) {
    if (row.change.ends_with("irradiance")) continue;  // the input's
    if (row.spots)
      values.push_back({"spots", row.change, static_cast<double>(row.spots->appear + row.spots->vanish)});
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string of = std::string(1, "RGB"[c]) + " " + row.change;
      values.push_back({"rel_rmse", of, row.flicker.relativeRmse[c]});
      values.push_back({"p999", of, row.flicker.p999[c]});
      values.push_back({"worst", of, row.flicker.worst[c]});
    }
  }
  if (const std::string over = limits.over(values); !over.empty()) throw LimitExceeded(over);
}

}  // namespace

void addFlickerCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand(
      "flicker",
      "Say what changes in a model, a capture or a scene when the camera moves by pixels or lights turn");
  addCaptureOptions(command, options->scene, SceneUse::Replay);
  const std::vector<std::string> sceneOptions = command.options();
  options->settings.addTo(command);
  command.option("--pixels", options->pixels, "moves to the right, whole pixels; negative: to the left");
  command
      .option("--light-degrees", options->lightDegrees,
              "degrees by which lights turn; 0: none; a capture's lights stand still")
      .range(-10.0, 10.0);
  const auto path = command.option("--path", options->paths,
                                   "of a model: also follow these paths, with commas: " + pathSyntax() +
                                       ". Angles change by 0.5 degrees a frame, the distance of a dolly by 1 "
                                       "%, and a blinking light each 6 "
                                       "frames");
  command.option("--frames", options->frames, "of each path").range(2, 1000).needs(path);
  command
      .option(
          "--picture", options->picture,
          "PNG to write: four frames of the path, and below each its change since the frame before, on gray")
      .needs(path);
  command
      .option("--limit", options->limits,
              "exit with 1 when any channel of any change exceeds it: rel_rmse=, p999=, worst=; or when "
              "more spots "
              "appear and vanish: spots=")
      .separatedBy(',');
  command.flag("--json", options->json, "print JSON");
  command.footer(kDefinitions);
  command.run([options, command, sceneOptions] { flicker(command, sceneOptions, *options); });
}

}  // namespace pellucid::harness
