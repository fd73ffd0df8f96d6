#include "common/compare.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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
#include "common/error.h"
#include "common/png.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefinitions =
    "rel_rmse: sqrt(mean (A-B)^2) / RMS(B). p999, max: of |A-B| / RMS(B). psnr: 20 log10(max B / RMSE), dB.\n"
    "bias: mean A / mean B - 1. Each channel by itself, over the samples.\n";

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

struct Options {
  std::string a, b, mask, diff, subset = "all";
  int box = 1;
  double boxCoverage = 0.5;
  std::vector<std::string> limits;
  bool json = false;
};

struct Limit {
  const Measure* measure;
  double value;

  // psnr says how good, the others how bad. A value that is not a number is over.
  bool allows(double measured) const {
    return std::string(measure->name) == "psnr" ? measured >= value : std::abs(measured) <= value;
  }
};

Limit parseLimit(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto measure =
      std::find_if(kMeasures.begin(), kMeasures.end(), [&](const Measure& m) { return m.name == name; });
  if (equals == std::string::npos || measure == kMeasures.end())
    throw UsageError("--limit \"" + text + "\": must be rel_rmse=, p999=, max=, psnr= or bias= and a number");
  Limit limit{&*measure, 0};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, limit.value);
  if (error != std::errc() || stop != end || !(limit.value >= 0))
    throw UsageError("--limit \"" + text + "\": \"" + text.substr(equals + 1) + "\" is not a number >= 0");
  return limit;
}

// The capture a path names, or nothing for an EXR that is just an image.
std::optional<Capture> findCapture(const std::filesystem::path& path) {
  if (isExr(path) && !ExrFile(path).findText(kManifestAttribute)) return std::nullopt;
  return readCapture(path);
}

// A | B | 4 |A - B|, exposed so that the 99th percentile of B is white; pixels that do not count are
// black in the difference.
void writeDifference(const std::filesystem::path& path, const Image& a, const Image& b,
                     const std::vector<std::uint8_t>& mask) {
  constexpr float kAmplification = 4;
  std::vector<float> values;
  Image difference(a.width, a.height, a.channels);
  for (std::size_t i = 0; i < b.data.size(); ++i) {
    if (!mask.empty() && mask[i / static_cast<std::size_t>(b.channels)] == 0) continue;
    difference.data[i] = kAmplification * std::abs(a.data[i] - b.data[i]);
    if (std::isfinite(b.data[i])) values.push_back(b.data[i]);
  }
  float white = 0;
  if (!values.empty()) {
    const auto rank = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
    std::nth_element(values.begin(), rank, values.end());
    white = *rank;
  }
  const Image panels = sideBySide({&a, &b, &difference});
  writePng(path, panels.width, panels.height, toSrgb(panels, white > 0 ? 1 / white : 1));
}

Json toJson(const Comparison& comparison, const Options& options) {
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
  return json;
}

std::string toText(const Comparison& comparison, const Options& options) {
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
  text << kDefinitions;
  return text.str();
}

void checkLimits(const Comparison& comparison, const std::vector<Limit>& limits) {
  std::ostringstream over;
  for (const Limit& limit : limits)
    for (std::size_t c = 0; c < comparison.channels.size(); ++c)
      if (const double value = comparison.channels[c].*limit.measure->value; !limit.allows(value))
        over << (over.str().empty() ? "" : "; ") << limit.measure->name << " of " << kChannelNames[c]
             << " is " << value << ", the limit " << limit.value;
  if (!limits.empty() && comparison.nonFiniteA)
    over << (over.str().empty() ? "" : "; ") << comparison.nonFiniteA << " pixels of A are not finite";
  if (!over.str().empty()) throw LimitExceeded(over.str());
}

void compare(const Options& options) {
  std::vector<Limit> limits;
  for (const std::string& limit : options.limits) limits.push_back(parseLimit(limit));

  const Image a = readExrImage(options.a);
  std::optional<Capture> capture = findCapture(options.b);
  if (capture && !capture->truth)
    throw InputError(options.b, "truth", "missing: the capture has no image to compare with");
  const Image b = capture ? std::move(capture->truth->image) : readExrImage(options.b);
  if (!options.mask.empty()) capture = readCapture(options.mask);
  const Subset subset = options.subset == "lit"     ? Subset::Lit
                        : options.subset == "unlit" ? Subset::Unlit
                                                    : Subset::All;
  if (subset != Subset::All && !capture)
    throw UsageError("--subset needs a capture, for its irradiance: give --mask, or a manifest as B");

  const std::vector<std::uint8_t> mask =
      capture ? comparisonMask(capture->material, capture->irradiance, subset) : std::vector<std::uint8_t>();
  Comparison comparison;
  try {
    comparison = compareImages(a, b, mask, options.box, options.boxCoverage);
  } catch (const InputError& error) {
    throw InputError(options.a + " (A), " + options.b + " (B)", "", error.what());
  }
  std::cout << (options.json ? toJson(comparison, options).dump(2) + "\n" : toText(comparison, options));
  if (!options.diff.empty()) writeDifference(options.diff, a, b, mask);
  checkLimits(comparison, limits);
}

}  // namespace

void addCompareCommand(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "Say how far image A is from image B, per channel");
  command->add_option("A", options->a, "EXR image")->required();
  command->add_option("B", options->b, "EXR image, or a capture: its truth, over its material pixels")
      ->required();
  command->add_option("--mask", options->mask,
                      "capture whose material pixels count (default: B's, else all pixels)");
  command->add_option("--box", options->box, "average blocks of NxN pixels first")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command
      ->add_option("--box-coverage", options->boxCoverage,
                   "part of a block's pixels that must count, else it is left out")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--subset", options->subset,
                   "pixels that count: all, or those lit or unlit from the front")
      ->check(CLI::IsMember({"all", "lit", "unlit"}))
      ->capture_default_str();
  command
      ->add_option(
          "--limit", options->limits,
          "exit with 1 when a channel exceeds it: rel_rmse=, p999=, max=, bias= (at most), psnr= (at least)")
      ->delimiter(',')
      ->take_all();
  command->add_option("--diff", options->diff, "write a PNG: A, B, 4 |A-B|");
  command->add_flag("--json", options->json, "print JSON; infinity is null");
  command->footer(kDefinitions);
  command->callback([options] { compare(*options); });
}

}  // namespace pellucid::harness
