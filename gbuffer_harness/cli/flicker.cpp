// `pellucid flicker`: what changes in a result when the camera moves by whole pixels or lights turn a little.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
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
#include "common/progress.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "raster/framing.h"
#include "replay/replay.h"

namespace pellucid::harness {

namespace {

constexpr const char* kDefinitions =
    "A row compares two frames that should look alike, by the difference between them, R G B.\n"
    "rel_rmse: RMS of the difference over the RMS of the still frame. p999, worst: 99.9th percentile and\n"
    "maximum of the difference over the mean of the still frame's 5x5 pixels around.\n"
    "moved: the view lies some pixels to the side.\n"
    "lights turned: the lights turn about the vertical through the scene's center. The difference is the\n"
    "change less its mean over 5x5 pixels, as diffused light changes evenly; hard shadows' edges count.\n"
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
  std::vector<std::string> limits;
};

// A frame, and the same with turned lights where there are any to turn.
struct Frames {
  Capture still;
  std::optional<Capture> turned;
};

struct Row {
  std::string change;
  Flicker flicker;
  std::optional<SpotFlicker> spots = {};  // of results whose lights turned
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
    for (Light& light : scene.model.lights)
      light = turnedLight(light, center, options.lightDegrees * std::numbers::pi / 180);
    frames.turned = captureScene(device, scene.model, scene.camera, scene.raster, sky).capture;
  }
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
                    compareShifted(still, moved, mask, k, 0)});
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
                    compareTurned(base.irradiance, turned.irradiance, surfaces, mask)});
  }
  return rows;
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
  const std::vector<Row> rows = measure(options, pixels, frames, settings, device);
  std::cout << frames.still.name << ", " << frames.still.width << "x" << frames.still.height << ", "
            << rows.front().flicker.pixels << " pixels, " << options.settings.text() << ", on "
            << device.description() << "\n\n"
            << toMarkdown(rows) << "\n"
            << kDefinitions;
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
  command
      .option("--limit", options->limits,
              "exit with 1 when any channel of any change exceeds it: rel_rmse=, p999=, worst=; or when "
              "more spots "
              "appear and vanish: spots=")
      .separatedBy(',');
  command.footer(kDefinitions);
  command.run([options, command, sceneOptions] { flicker(command, sceneOptions, *options); });
}

}  // namespace pellucid::harness
