#include "common/compare.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "capture/exr.h"
#include "capture/read.h"
#include "cli/command.h"
#include "cli/commands.h"
#include "cli/limits.h"
#include "cli/metrics_json.h"
#include "cli/settings.h"
#include "common/error.h"
#include "common/png.h"
#include "metrics/eye.h"
#include "metrics/spots.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefinitions =
    "rel_rmse: sqrt(mean (A-B)^2) / RMS(B). p999, max: of |A-B| / RMS(B). psnr: 20 log10(max B / RMSE), dB.\n"
    "bias: mean A / mean B - 1. Each channel by itself, over the samples.\n"
    "isolated: pixels 1.3 times above or below all neighbors of their surface; not in B where B's pixel is\n"
    "not 1.1 times above or below in the same way. spots: regions of up to 5x5 pixels 1.3 times above or "
    "below\n"
    "the median of their surface around, by more than the irradiance of the capture has; not in B where A's\n"
    "contrast is 1.3 times B's. tint: standard deviation of\n"
    "A / B over 8x8 averages, per channel and of red over green. flip: LDR-FLIP under one exposure, 0 .. 1.\n"
    "noise: B's standard errors over its RMS. chi2: sum of (A-B)^2 over the sum of squared standard errors,\n"
    "in samples wholly of mask: 1 where noise is all that differs. Both need files with standard errors.\n"
    "docs/accuracy.md has the definitions.\n";

struct Measure {
  const char* name;
  double ChannelDifference::*value;
};
constexpr std::array<Measure, 5> kMeasures = {{{"rel_rmse", &ChannelDifference::relativeRmse},
                                               {"p999", &ChannelDifference::p999},
                                               {"max", &ChannelDifference::max},
                                               {"psnr", &ChannelDifference::psnr},
                                               {"bias", &ChannelDifference::bias}}};
constexpr std::array<const char*, 3> kChannelNames = {"R", "G", "B"};

const std::vector<LimitKind> kLimitKinds = {
    {"rel_rmse"},       {"p999"},  {"max"},         {"psnr", true}, {"bias"}, {"isolated"},
    {"isolated_alone"}, {"spots"}, {"spots_alone"}, {"tint"},       {"flip"}, {"flip_p99"}};

struct Options {
  std::string a, b, mask, diff, ratio, isolated, layer, subset = "all";
  double scale = 1;
  int box = 1;
  double boxCoverage = 0.5, exposure = 0;
  std::vector<std::string> limits;
  bool json = false;
};

struct Result {
  std::vector<double> noise, chi2;  // of B; empty where no standard errors are known
  Comparison comparison;
  IsolatedPixels isolatedA, isolatedB;
  std::size_t aloneA = 0;  // of A's, those that do not stick out of B even a little
  std::vector<Spot> spotsA, spotsB, spotsAloneA;
  Tint tint;
  Flip flip;
};

// The capture a path names, or nothing for an EXR that is just an image.
std::optional<Capture> findCapture(const std::filesystem::path& path) {
  if (isExr(path) && !ExrFile(path).findText(kManifestAttribute)) return std::nullopt;
  return readCapture(path);
}

// An image to compare: of a capture its truth, with what is known of its noise.
Truth readTruth(const std::string& path, const std::optional<Capture>& capture,
                const std::string& layer = "") {
  if (!capture) return {readExrImage(path, layer), {}};
  if (!capture->truth) throw InputError(path, "truth", "missing: the capture has no image to compare with");
  return *capture->truth;
}

// A | B | 4 |A - B|, exposed so that the 99th percentile of B is white; pixels that do not count are
// black in the difference.
void writeDifference(const std::filesystem::path& path, const Image& a, const Image& b, const Mask& mask) {
  constexpr float kAmplification = 4;
  std::vector<float> values;
  Image difference(a.width, a.height, a.channels);
  for (std::size_t i = 0; i < b.data.size(); ++i) {
    if (mask[i / static_cast<std::size_t>(b.channels)] == 0) continue;
    difference.data[i] = kAmplification * std::abs(a.data[i] - b.data[i]);
    if (std::isfinite(b.data[i])) values.push_back(b.data[i]);
  }
  float white = 0;
  if (!values.empty()) {
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
    std::nth_element(values.begin(), rank, values.end());
    white = *rank;
  }
  const Image panels = contactSheet({&a, &b, &difference}, 3);
  writePng(path, panels.width, panels.height, toSrgb(panels, white > 0 ? 1 / white : 1));
}

Json toJson(const IsolatedPixels& isolated) {
  return {{"count", isolated.count}, {"bright", isolated.bright}, {"dark", isolated.dark}};
}

Json toJson(const std::vector<Spot>& spots) {
  const std::size_t bright = brightOf(spots);
  return {{"count", spots.size()}, {"bright", bright}, {"dark", spots.size() - bright}};
}

Json toJson(const Result& result, const Options& options) {
  const Comparison& comparison = result.comparison;
  Json json = {{"a", options.a},
               {"b", options.b},
               {"box", options.box},
               {"boxCoverage", options.boxCoverage},
               {"pixels", comparison.pixels},
               {"samples", comparison.samples},
               {"nonFinite", {{"a", comparison.nonFiniteA}, {"b", comparison.nonFiniteB}}}};
  for (const Measure& measure : kMeasures)
    for (const ChannelDifference& channel : comparison.channels)
      json[measure.name].push_back(channel.*measure.value);  // infinity becomes null
  if (!result.noise.empty()) json["noise"] = result.noise;
  if (!result.chi2.empty()) json["chi2"] = result.chi2;
  json["isolated"] = {
      {"a", toJson(result.isolatedA)}, {"b", toJson(result.isolatedB)}, {"aAlone", result.aloneA}};
  json["spots"] = {
      {"a", toJson(result.spotsA)}, {"b", toJson(result.spotsB)}, {"aAlone", toJson(result.spotsAloneA)}};
  json["tint"] = toJson(result.tint);
  json["flip"] = toJson(result.flip);
  return json;
}

std::string toText(const Result& result, const Options& options) {
  const Comparison& comparison = result.comparison;
  std::ostringstream text;
  text << options.a << " (A) against " << options.b << " (B): " << comparison.pixels << " pixels";
  if (options.box > 1)
    text << ", " << comparison.samples << " blocks of " << options.box << "x" << options.box;
  text << "\n";
  text.precision(4);
  text << std::setw(3) << "";
  for (const Measure& measure : kMeasures) text << std::setw(12) << measure.name;
  text << "\n";
  for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
    text << std::setw(3) << kChannelNames[c];
    for (const Measure& measure : kMeasures) text << std::setw(12) << comparison.channels[c].*measure.value;
    text << "\n";
  }
  if (comparison.nonFiniteA || comparison.nonFiniteB)
    text << "  NaN or infinity in " << comparison.nonFiniteA << " pixels of A and " << comparison.nonFiniteB
         << " of B, left out\n";
  const auto numbers = [&](const char* name, const std::vector<double>& values) {
    if (values.empty()) return;
    text << "  " << name << ": ";
    for (const double value : values) text << value << " ";
    text << "(R G B)\n";
  };
  numbers("noise of B", result.noise);
  numbers("chi2", result.chi2);
  const auto counted = [](std::size_t count, std::size_t bright, std::size_t dark) {
    return std::to_string(count) + " (" + std::to_string(bright) + " bright, " + std::to_string(dark) +
           " dark)";
  };
  const auto isolated = [&](const IsolatedPixels& pixels) {
    return counted(pixels.count, pixels.bright, pixels.dark);
  };
  const auto spots = [&](const std::vector<Spot>& all) {
    return counted(all.size(), brightOf(all), all.size() - brightOf(all));
  };
  text << "  isolated pixels: A has " << isolated(result.isolatedA) << ", " << result.aloneA
       << " of them not in B, which has " << isolated(result.isolatedB) << "\n  spots: A has "
       << spots(result.spotsA) << ", " << result.spotsAloneA.size() << " of them not in B, which has "
       << spots(result.spotsB) << "\n  tint: ";
  for (const double value : result.tint.channel) text << value << " ";
  text << "(R G B), red over green " << result.tint.redOverGreen << ", of " << result.tint.blocks
       << " blocks\n  flip: mean " << result.flip.mean << ", 99th percentile " << result.flip.p99
       << ", at exposure " << result.flip.exposure << "\n"
       << kDefinitions;
  return text.str();
}

void checkLimits(const Result& result, const Limits& limits) {
  const Comparison& comparison = result.comparison;
  std::vector<Measured> values = {{"isolated", "A", static_cast<double>(result.isolatedA.count)},
                                  {"isolated_alone", "A", static_cast<double>(result.aloneA)},
                                  {"spots", "A", static_cast<double>(result.spotsA.size())},
                                  {"spots_alone", "A", static_cast<double>(result.spotsAloneA.size())},
                                  {"tint", "red over green", result.tint.redOverGreen},
                                  {"flip", "", result.flip.mean},
                                  {"flip_p99", "", result.flip.p99}};
  for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
    values.push_back({"tint", kChannelNames[c], result.tint.channel[c]});
    for (const Measure& measure : kMeasures)
      values.push_back({measure.name, kChannelNames[c], comparison.channels[c].*measure.value});
  }
  std::string over = limits.over(values);
  if (!limits.empty() && comparison.nonFiniteA)
    over +=
        (over.empty() ? "" : "; ") + std::to_string(comparison.nonFiniteA) + " pixels of A are not finite";
  if (!over.empty()) throw LimitExceeded(over);
}

void compare(const Options& options) {
  const Limits limits(kLimitKinds, options.limits);
  const Truth truthA = readTruth(options.a, findCapture(options.a));
  std::optional<Capture> capture;
  if (options.layer.empty()) capture = findCapture(options.b);
  Truth truthB = readTruth(options.b, capture, options.layer);
  for (Image* image : {&truthB.image, &truthB.standardError})
    for (float& value : image->data) value *= static_cast<float>(options.scale);
  const Image &a = truthA.image, &b = truthB.image;
  if (!options.mask.empty()) capture = readCapture(options.mask);
  const Subset subset = options.subset == "lit"     ? Subset::Lit
                        : options.subset == "unlit" ? Subset::Unlit
                                                    : Subset::All;
  if (subset != Subset::All && !capture)
    throw UsageError("--subset needs a capture, for its irradiance: give --mask, or a manifest as B");

  Mask mask = capture ? comparisonMask(capture->material, capture->irradiance, subset) : Mask(a.pixels(), 1);
  Result result;
  try {
    result.comparison = compareImages(a, b, mask, options.box, options.boxCoverage);
  } catch (const InputError& error) {
    throw InputError(options.a + " (A), " + options.b + " (B)", "", error.what());
  }
  if (!truthB.standardError.empty()) result.noise = relativeNoise(b, truthB.standardError, mask, options.box);
  if (!truthA.standardError.empty() || !truthB.standardError.empty())
    result.chi2 = chiSquared(a, truthA.standardError, b, truthB.standardError, mask, options.box);
  const Surfaces surfaces = capture ? Surfaces(*capture) : Surfaces(b.width, b.height);
  result.isolatedA = findIsolated(a, surfaces, mask);
  result.isolatedB = findIsolated(b, surfaces, mask);
  result.aloneA = result.isolatedA.alone(findIsolated(b, surfaces, mask, kNearlyIsolated));
  const SpotImage spotImageA(a, surfaces, mask), spotImageB(b, surfaces, mask);
  std::optional<SpotImage> input;
  if (capture) input.emplace(litAlbedo(*capture), surfaces, mask);
  const SpotImage* explains = input ? &*input : nullptr;
  result.spotsA = spotImageA.find(explains);
  result.spotsB = spotImageB.find(explains);
  result.spotsAloneA = spotImageA.lackedBy(spotImageB, result.spotsA);
  result.tint = measureTint(a, b, mask);
  result.flip = measureFlip(a, b, mask, options.exposure);
  std::cout << (options.json ? toJson(result, options).dump(2) + "\n" : toText(result, options));
  if (!options.diff.empty()) writeDifference(options.diff, a, b, mask);
  if (!options.ratio.empty()) writePng(options.ratio, b.width, b.height, ratioMap(a, b, mask));
  if (!options.isolated.empty())
    writePng(options.isolated, a.width, a.height,
             markSpots(markIsolated(a, result.isolatedA, static_cast<float>(result.flip.exposure)), a,
                       result.spotsA, result.spotsAloneA));
  checkLimits(result, limits);
}

}  // namespace

void addCompareCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand("compare", "Say how far image A is from image B, per channel");
  command.option("A", options->a, "EXR image, or a capture: its truth").required();
  command.option("B", options->b, "EXR image, or a capture: its truth, over its material pixels").required();
  command.option("--mask", options->mask,
                 "capture whose material pixels count (default: B's, else all pixels)");
  command.option("--layer", options->layer,
                 "layer of B whose R, G, B are compared; B then counts as an image");
  command.option("--scale", options->scale, "factor of B, as pi for a pass that holds E / pi").positive();
  command.option("--box", options->box, "average blocks of NxN pixels first").range(1, 4096);
  command
      .option("--box-coverage", options->boxCoverage,
              "part of a block's pixels that must count, else it is left out")
      .range(0.0, 1.0);
  command.option("--subset", options->subset, "pixels that count: all, or those lit or unlit from the front")
      .oneOf({"all", "lit", "unlit"});
  command
      .option(
          "--limit", options->limits,
          "exit with 1 when a channel exceeds it: rel_rmse=, p999=, max=, bias=, tint= (at most), psnr= (at "
          "least); or the whole: isolated=, isolated_alone=, spots=, spots_alone=, flip=, "
          "flip_p99= (at most)")
      .separatedBy(',');
  command.option("--diff", options->diff, "write a PNG: A, B, 4 |A-B|");
  command.option("--ratio", options->ratio,
                 "write a PNG of A / B over 4x4 averages: gray where right, full color at 10 % off");
  command.option("--isolated", options->isolated,
                 "write a PNG of A with its isolated pixels and its spots framed");
  command
      .option("--exposure", options->exposure,
              "factor for flip and --isolated; default: B's 99th percentile to 0.8")
      .positive();
  command.flag("--json", options->json, "print JSON; infinity is null");
  command.footer(kDefinitions);
  command.run([options] { compare(*options); });
}

}  // namespace pellucid::harness
