#include "common/compare.h"

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
#include "cli/settings.h"
#include "common/error.h"
#include "common/png.h"
#include "metrics/eye.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefinitions =
    "rel_rmse: sqrt(mean (A-B)^2) / RMS(B). p999, max: of |A-B| / RMS(B). psnr: 20 log10(max B / RMSE), dB.\n"
    "bias: mean A / mean B - 1. Each channel by itself, over the samples.\n"
    "isolated: pixels 1.3 times above or below all neighbors of their surface. spots: regions of up to 5x5\n"
    "pixels 1.3 times above or below the median of their surface around, by more than B and the irradiance of\n"
    "the capture have. tint: standard deviation of A / B over 8x8 averages, per channel and of red over green.\n"
    "flip: LDR-FLIP under one exposure, 0 .. 1. noise: B's standard errors over its RMS.\n"
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
    {"rel_rmse"}, {"p999"}, {"max"}, {"psnr", true}, {"bias"}, {"isolated"}, {"spots"}, {"tint"}, {"flip"}, {"flip_p99"}};

struct Options {
  std::string a, b, mask, ratio, subset = "all";
  int box = 1;
  double boxCoverage = 0.5;
  std::vector<std::string> limits;
  bool json = false;
};

struct Result {
  std::vector<double> noise;  // of B; empty where no standard errors are known
  Comparison comparison;
  EyeMetrics eye;
};

// The capture a path names, or nothing for an EXR that is just an image.
std::optional<Capture> findCapture(const std::filesystem::path& path) {
  if (isExr(path) && !ExrFile(path).findText(kManifestAttribute)) return std::nullopt;
  return readCapture(path);
}

// An image to compare: of a capture its truth, with what is known of its noise.
Truth readTruth(const std::string& path, const std::optional<Capture>& capture) {
  if (!capture) return {readExrImage(path), {}};
  if (!capture->truth) throw InputError(path, "truth", "missing: the capture has no image to compare with");
  return *capture->truth;
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
  const EyeMetrics& eye = result.eye;
  json["isolated"] = {{"a", eye.isolated}, {"b", eye.isolatedInTruth}};
  json["spots"] = eye.spots;
  json["tint"] = {
      {"channels", eye.tint.channel}, {"redOverGreen", eye.tint.redOverGreen}, {"blocks", eye.tint.blocks}};
  json["flip"] = {{"mean", eye.flip.mean}, {"p99", eye.flip.p99}};
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
  if (!result.noise.empty()) {
    text << "  noise of B: ";
    for (const double value : result.noise) text << value << " ";
    text << "(R G B)\n";
  }
  const EyeMetrics& eye = result.eye;
  text << "  isolated pixels: A has " << eye.isolated << ", B has " << eye.isolatedInTruth
       << "\n  spots that B lacks: " << eye.spots << "\n  tint: ";
  for (const double value : eye.tint.channel) text << value << " ";
  text << "(R G B), red over green " << eye.tint.redOverGreen << ", of " << eye.tint.blocks
       << " blocks\n  flip: mean " << eye.flip.mean << ", 99th percentile " << eye.flip.p99 << "\n"
       << kDefinitions;
  return text.str();
}

void checkLimits(const Result& result, const Limits& limits) {
  const Comparison& comparison = result.comparison;
  const EyeMetrics& eye = result.eye;
  std::vector<Measured> values = {{"isolated", "A", static_cast<double>(eye.isolated)},
                                  {"spots", "A", static_cast<double>(eye.spots)},
                                  {"tint", "red over green", eye.tint.redOverGreen},
                                  {"flip", "", eye.flip.mean},
                                  {"flip_p99", "", eye.flip.p99}};
  for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
    values.push_back({"tint", kChannelNames[c], eye.tint.channel[c]});
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
  std::optional<Capture> capture = findCapture(options.b);
  const Truth truthB = readTruth(options.b, capture);
  const Image &a = truthA.image, &b = truthB.image;
  if (!options.mask.empty()) capture = readCapture(options.mask);
  const Subset subset = options.subset == "lit"     ? Subset::Lit
                        : options.subset == "unlit" ? Subset::Unlit
                                                    : Subset::All;
  if (subset != Subset::All && !capture)
    throw UsageError("--subset needs a capture, for its irradiance: give --mask, or a manifest as B");

  const Mask mask = capture ? comparisonMask(capture->material, capture->irradiance, subset) : Mask(a.pixels(), 1);
  Result result;
  try {
    result.comparison = compareImages(a, b, mask, options.box, options.boxCoverage);
  } catch (const InputError& error) {
    throw InputError(options.a + " (A), " + options.b + " (B)", "", error.what());
  }
  if (!truthB.standardError.empty()) result.noise = relativeNoise(b, truthB.standardError, mask, options.box);
  result.eye = measureEye(a, b, mask, capture ? &*capture : nullptr);
  std::cout << (options.json ? toJson(result, options).dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : toText(result, options));
  if (!options.ratio.empty()) writePng(options.ratio, b.width, b.height, ratioMap(a, b, mask));
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
          "least); or the whole: isolated=, spots=, flip=, flip_p99= (at most)")
      .separatedBy(',');
  command.option("--ratio", options->ratio,
                 "write a PNG of A / B over 4x4 averages: gray where right, full color at 10 % off");
  command.flag("--json", options->json, "print JSON; infinity is null");
  command.footer(kDefinitions);
  command.run([options] { compare(*options); });
}

}  // namespace pellucid::harness
