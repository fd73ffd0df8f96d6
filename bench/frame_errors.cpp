#include "frame_errors.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "common/compare.h"
#include "common/parallel.h"
#include "metrics/eye.h"
#include "metrics/flicker.h"
#include "reference/diffusion.h"
#include "reference/surface.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr unsigned kSeed = 37;
// Share of the profile's energy that brute force leaves out: a tenth of the least error in the table.
constexpr double kDiscarded = 1e-4;

std::vector<std::uint32_t> choosePixels(const Capture& c, int count) {
  constexpr int kTile = 32;
  std::vector<std::uint32_t> covered;
  for (int top = 0; top < c.height; top += kTile)
    for (int left = 0; left < c.width; left += kTile)
      for (int y = top; y < std::min(top + kTile, c.height); ++y)
        for (int x = left; x < std::min(left + kTile, c.width); ++x) {
          const auto pixel = static_cast<std::uint32_t>(y * c.width + x);
          if (c.material[pixel] != 0) covered.push_back(pixel);
        }
  const size_t wanted = static_cast<size_t>(count);
  if (covered.size() > wanted) {
    std::mt19937 random(kSeed);
    std::vector<std::uint32_t> chosen;
    for (size_t i = 0; i < wanted; ++i) {
      const size_t first = i * covered.size() / wanted, end = (i + 1) * covered.size() / wanted;
      chosen.push_back(covered[first + random() % (end - first)]);
    }
    covered = std::move(chosen);
  }
  std::sort(covered.begin(), covered.end());
  return covered;
}

std::vector<std::array<double, 3>> bruteForce(const Capture& c,
                                              const std::vector<PellucidMaterial>& materials,
                                              const std::vector<std::uint32_t>& pixels) {
  const reference::SurfaceReader surfaces(c);
  std::vector<glm::dvec3> irradiance(c.material.size());
  for (size_t i = 0; i < irradiance.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const float e = c.irradiance.data[3 * i + static_cast<size_t>(k)];
      irradiance[i][k] = e > 0 ? std::min(static_cast<double>(e), 65504.0) : 0;  // as the reference has it
    }
  const reference::Diffusion diffusion(c, surfaces, materials, irradiance, kDiscarded);
  std::vector<std::array<double, 3>> values(pixels.size());
  parallelRows(static_cast<int>(pixels.size()), 0, [&](int i) {
    const auto pixel = static_cast<int>(pixels[static_cast<size_t>(i)]);
    const glm::dvec3 v = diffusion.at(pixel % c.width, pixel / c.width);
    values[static_cast<size_t>(i)] = {v.x, v.y, v.z};
  });
  return values;
}

}  // namespace

DiffusionTruth diffusionTruth(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                              int count) {
  DiffusionTruth truth;
  truth.pixels = choosePixels(capture, count);
  if (!truth.pixels.empty()) truth.values = bruteForce(capture, materials, truth.pixels);
  return truth;
}

ChannelErrors diffusionErrors(const Image& result, const DiffusionTruth& truth) {
  std::array<double, 3> squared{}, power{};
  for (size_t i = 0; i < truth.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      const double right = truth.values[i][c];
      const double off =
          static_cast<double>(result.data[static_cast<size_t>(result.channels) * truth.pixels[i] + c]) -
          right;
      squared[c] += off * off;
      power[c] += right * right;
    }
  ChannelErrors errors{};
  for (size_t c = 0; c < 3; ++c) {
    if (squared[c] == 0) continue;
    errors[c] = power[c] > 0 ? std::sqrt(squared[c] / power[c]) : INFINITY;
  }
  return errors;
}

double rootMeanSquare(const ChannelErrors& errors) {
  double sum = 0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

namespace {

Image timesAlbedo(Image image, const Capture& capture) {
  for (size_t i = 0; i < image.data.size() && !capture.albedo.empty(); ++i)
    image.data[i] *= capture.albedo.data[i];
  return image;
}

}  // namespace

nlohmann::json errorFields(Image result, const Capture& capture) {
  result = timesAlbedo(std::move(result), capture);
  const Comparison comparison = compareImages(
      result, capture.truth->image, comparisonMask(capture.material, capture.irradiance, Subset::All), kTruthBox);
  ChannelErrors errors{};
  for (size_t c = 0; c < 3; ++c) errors[c] = comparison.channels[c].relativeRmse;
  const EyeMetrics eye = measureEye(
      result, capture.truth->image, comparisonMask(capture.material, capture.irradiance, Subset::All), &capture);
  return {{"truth_relative_rmse", rootMeanSquare(errors)},
          {"truth_relative_rmse_rgb", errors},
          {"isolated", eye.isolated},
          {"spots", eye.spots},
          {"tint", eye.tint.channel},
          {"tint_red_green", eye.tint.redOverGreen},
          {"flip", eye.flip.mean},
          {"flip_p99", eye.flip.p99}};
}

nlohmann::json flickerFields(Image result, Image turnedResult, const Capture& capture,
                             const Capture& turned) {
  result = timesAlbedo(std::move(result), capture);
  turnedResult = timesAlbedo(std::move(turnedResult), turned);
  const Surfaces surfaces(capture);
  const Mask mask = comparisonMask(capture.material, capture.irradiance, Subset::All);
  const auto spotsOf = [&](const Image& image) { return SpotImage(image, surfaces, mask); };
  const SpotFlicker spots = compareSpots(spotsOf(result), spotsOf(litAlbedo(capture)), spotsOf(turnedResult),
                                         spotsOf(litAlbedo(turned)));
  return {{"flicker_rgb", compareTurned(result, turnedResult, surfaces, mask).relativeRmse},
          {"flicker_irradiance_rgb",
           compareTurned(capture.irradiance, turned.irradiance, surfaces, mask).relativeRmse},
          {"spots_appear", spots.appear},
          {"spots_vanish", spots.vanish}};
}

}  // namespace pellucid::bench
