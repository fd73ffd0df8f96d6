// `pellucid sheet`: results side by side in one picture, under one exposure.
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>

#include "capture/exr.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/numbers.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/png.h"
#include "common/progress.h"
#include "replay/replay.h"

namespace pellucid::harness {
namespace {

constexpr int kGap = 4;
constexpr std::size_t kMostPictures = 256;

struct Options {
  std::vector<std::string> inputs, sweeps, labels;
  std::string output, device;
  int columns = 0;               // 0: the last sweep's values, or 3
  std::vector<float> exposures;  // of all, or one for each picture
  ToneMap toneMap = ToneMap::None;
};

struct Picture {
  Image image;
  std::vector<std::string> labels;  // lines
};

// A setting of replay, or the material, with the values it takes in turn.
struct Sweep {
  std::string key;
  std::vector<std::string> values;
};

std::deque<Picture> readPictures(const Options& options) {
  if (!options.labels.empty() && options.labels.size() != options.inputs.size())
    throw UsageError("--label: " + std::to_string(options.labels.size()) + " are given for " +
                     std::to_string(options.inputs.size()) + " images");
  std::deque<Picture> pictures;
  for (const std::string& input : options.inputs) {
    // The @ may be part of a file's name.
    const std::size_t at = std::filesystem::exists(input) ? std::string::npos : input.rfind('@');
    pictures.push_back({at == std::string::npos ? readExrImage(input)
                                                : readExrImage(input.substr(0, at), input.substr(at + 1)),
                        {}});
    if (!options.labels.empty()) pictures.back().labels = {options.labels[pictures.size() - 1]};
    const Image &image = pictures.back().image, &first = pictures.front().image;
    if (image.width != first.width || image.height != first.height)
      throw InputError(input, "",
                       "is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                           " and \"" + options.inputs.front() + "\" " + std::to_string(first.width) + " x " +
                           std::to_string(first.height));
  }
  return pictures;
}

std::vector<Sweep> parseSweeps(const std::vector<std::string>& texts) {
  std::vector<Sweep> sweeps;
  std::size_t count = 1;
  for (const std::string& text : texts) {
    const Assignment sweep = parseAssignment("--sweep", text);
    sweeps.push_back({sweep.key, split(sweep.value, ',')});
    count *= sweeps.back().values.size();
  }
  if (count > kMostPictures)
    throw UsageError("--sweep: " + std::to_string(count) + " pictures are more than " +
                     std::to_string(kMostPictures));
  return sweeps;
}

// Every combination; the last sweep's values change first.
std::deque<Picture> replaySweeps(const Options& options, const std::vector<Sweep>& sweeps) {
  if (!options.labels.empty()) throw UsageError("--label: --sweep labels its pictures");
  if (options.inputs.size() != 1) throw UsageError("--sweep: takes one capture");
  const Capture source = readCapture(options.inputs.front());
  Device device({options.device, false});
  Replayer replayer(device);
  std::size_t count = 1;
  for (const Sweep& sweep : sweeps) count *= sweep.values.size();
  Progress progress("replaying", count);
  std::deque<Picture> pictures;
  for (std::size_t i = 0; i < count; ++i) {
    Capture capture = source;
    SettingsOptions settings;
    Picture& picture = pictures.emplace_back();
    std::size_t rest = i, block = count;
    for (const Sweep& sweep : sweeps) {
      block /= sweep.values.size();
      const std::string& value = sweep.values[rest / block];
      rest %= block;
      picture.labels.push_back(sweep.key + "=" + value);
      if (sweep.key == "material")
        std::fill(capture.materials.begin(), capture.materials.end(), MaterialSource(PresetMaterial{value}));
      else
        settings.set.push_back(sweep.key + "=" + value);
    }
    const ReplaySettings parsed = settings.parse();
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    picture.image = rgb(replayer.run(capture, materials, parsed).output);
    progress.advance();
  }
  return pictures;
}

// White on dark strips at the picture's lower left, no farther right than the picture.
void drawLabels(const std::vector<std::string>& labels, int left, int bottom, const Image& picture, int width,
                std::vector<std::uint8_t>& rgb) {
  constexpr int kMargin = 2, kLine = kTextHeight + 2 * kMargin;
  const auto fill = [&](const TextRect& rect, std::uint8_t gray) {
    for (int y = std::max(rect.top, bottom - picture.height); y < std::min(rect.bottom, bottom); ++y)
      for (int x = rect.left; x < std::min(rect.right, left + picture.width); ++x)
        std::fill_n(rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width + x), 3, gray);
  };
  int top = bottom - kLine * static_cast<int>(labels.size());
  for (const std::string& label : labels) {
    fill({left, top, left + textWidth(label) + 2 * kMargin, top + kLine}, 0);
    for (const TextRect& r : textRects(label))
      fill({left + kMargin + r.left, top + kMargin + r.top, left + kMargin + r.right,
            top + kMargin + r.bottom},
           255);
    top += kLine;
  }
}

void sheet(const Options& options) {
  const std::vector<Sweep> sweeps = parseSweeps(options.sweeps);
  std::deque<Picture> pictures = sweeps.empty() ? readPictures(options) : replaySweeps(options, sweeps);
  const int columns = options.columns > 0 ? options.columns
                      : sweeps.empty()    ? 3
                                          : static_cast<int>(sweeps.back().values.size());
  std::vector<float> exposures = options.exposures;
  if (exposures.size() > 1 && exposures.size() != pictures.size())
    throw UsageError("--exposure: " + std::to_string(exposures.size()) + " are given for " +
                     std::to_string(pictures.size()) + " images");
  std::vector<const Image*> pointers;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (float& value : pictures[i].image.data)
      if (exposures.size() > 1) value *= exposures[i];
    pointers.push_back(&pictures[i].image);
  }
  const Image all = contactSheet(pointers, columns, kGap);
  // One exposure for all, unless asked otherwise: brightness is part of what is compared.
  const float exposure = exposures.empty() ? autoExposure(all) : exposures.size() == 1 ? exposures[0] : 1;
  std::vector<std::uint8_t> rgb = toSrgb(all, exposure, options.toneMap);
  const Image& first = pictures.front().image;
  const int across = std::min(columns, static_cast<int>(pictures.size()));
  for (int i = 0; i < static_cast<int>(pictures.size()); ++i)
    drawLabels(pictures[static_cast<std::size_t>(i)].labels, i % across * (first.width + kGap),
               i / across * (first.height + kGap) + first.height, first, all.width, rgb);
  writePng(options.output, all.width, all.height, rgb);
  std::printf("wrote %s (%zu images, exposure %g)\n", options.output.c_str(), pictures.size(),
              static_cast<double>(exposure));
}

}  // namespace

void addSheetCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand(
      "sheet", "Lay EXR images, or one capture's variants, out in one PNG, under one exposure by default");
  command
      .option("images", options->inputs,
              "EXR files of one size, FILE@LAYER for another layer; with --sweep one capture")
      .required();
  command.option("-o,--output", options->output, "PNG to write").required();
  command.option("--sweep", options->sweeps,
                 "KEY=VALUE,VALUE,..., repeatable: replays the capture with each value of a key of "
                 "replay's --set, or of material, a preset in place of all materials; combinations, labeled");
  command.option("--label", options->labels, "text on an image, repeatable: one for each, in their order");
  command.option("--columns", options->columns, "images a row (default: the last sweep's values, else 3)")
      .range(1, 64);
  command
      .option("--exposure", options->exposures,
              "factor, or one for each image, separated by commas (default: one from the pictures)")
      .separatedBy(',')
      .positive();
  addToneMapOption(command, options->toneMap);
  command.option("--device", options->device, "of --sweep: part of the Vulkan device's name");
  command.run([options] { sheet(*options); });
}

}  // namespace pellucid::harness
