#include "metrics/eye.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace pellucid::harness {

namespace {

constexpr int kFewestNeighbors = 5;
constexpr std::uint8_t kBright = 1, kDark = 2;

struct Neighborhood {
  std::array<double, 3> least, largest;
  int pixels = 0;
};

Neighborhood around(const Image& image, const Surfaces& surfaces, const Mask& mask, int x, int y) {
  Neighborhood found;
  found.least.fill(std::numeric_limits<double>::infinity());
  found.largest.fill(-std::numeric_limits<double>::infinity());
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || !surfaces.connected(x, y, dx, dy)) continue;
      if (!counts(image, mask, x + dx, y + dy)) continue;
      ++found.pixels;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = image.at(x + dx, y + dy)[c];
        found.least[c] = std::min(found.least[c], value);
        found.largest[c] = std::max(found.largest[c], value);
      }
    }
  return found;
}

}  // namespace

IsolatedPixels findIsolated(const Image& image, const Surfaces& surfaces, const Mask& mask) {
  constexpr double kContrast = 1.3;
  requireImage("image", image, surfaces.width(), surfaces.height(), mask);
  IsolatedPixels result;
  result.marks.resize(image.pixels());
  const std::array<double, 3> rms = rmsOf(image, mask);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!counts(image, mask, x, y)) continue;
      const Neighborhood neighbors = around(image, surfaces, mask, x, y);
      if (neighbors.pixels < kFewestNeighbors) continue;
      std::uint8_t mark = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = image.at(x, y)[c], seen = kDarkestPart * rms[c];
        if (value > seen && value > kContrast * neighbors.largest[c]) mark |= kBright;
        if (neighbors.least[c] > seen && value * kContrast < neighbors.least[c]) mark |= kDark;
      }
      result.count += mark != 0;
      result.marks[pixelIndex(image, x, y)] = mark;
    }
  return result;
}

namespace {

double deviation(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

Tint measureTint(const Image& a, const Image& b, const Mask& mask) {
  requireImage("A", a, b.width, b.height, mask);
  requireImage("B", b, b.width, b.height, mask);
  const std::array<double, 3> rms = rmsOf(b, mask);
  std::array<std::vector<double>, 4> ratios;
  for (int top = 0; top + kTintBlock <= a.height; top += kTintBlock)
    for (int left = 0; left + kTintBlock <= a.width; left += kTintBlock) {
      const BlockMeans means = blockMeans(a, b, mask, left, top, kTintBlock);
      bool judged = means.pixels == kTintBlock * kTintBlock;
      for (std::size_t c = 0; c < 3; ++c) judged = judged && means.b[c] > kTintDarkestPart * rms[c];
      if (!judged) continue;
      for (std::size_t c = 0; c < 3; ++c) ratios[c].push_back(means.a[c] / means.b[c]);
      // A black result has no color; its blocks count as untinted, their darkness shows in the channels.
      const double red = ratios[0].back(), green = ratios[1].back();
      ratios[3].push_back(green > 0 ? red / green : 1);
    }
  Tint tint;
  tint.blocks = ratios[0].size();
  for (std::size_t c = 0; c < 3; ++c) tint.channel[c] = deviation(ratios[c]);
  tint.redOverGreen = deviation(ratios[3]);
  return tint;
}

std::vector<std::uint8_t> ratioMap(const Image& a, const Image& b, const Mask& mask) {
  requireImage("A", a, b.width, b.height, mask);
  requireImage("B", b, b.width, b.height, mask);
  const std::array<double, 3> rms = rmsOf(b, mask);
  std::vector<std::uint8_t> picture(3 * a.pixels());
  for (int top = 0; top < a.height; top += kRatioBlock)
    for (int left = 0; left < a.width; left += kRatioBlock) {
      const BlockMeans means = blockMeans(a, b, mask, left, top, kRatioBlock);
      std::array<std::uint8_t, 3> color;
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = means.a[c] - means.b[c];
        const double floor = std::max(means.b[c], kDarkestPart * rms[c]);
        // 0 / 0 is equal; anything over 0 is infinitely far.
        const double error = difference == 0 ? 0 : difference / floor;
        color[c] = static_cast<std::uint8_t>(
            std::lround(127.5 + 127.5 * std::clamp(error / kRatioFullColor, -1.0, 1.0)));
      }
      for (int y = top; y < std::min(top + kRatioBlock, a.height); ++y)
        for (int x = left; x < std::min(left + kRatioBlock, a.width); ++x)
          if (counts(a, mask, x, y) && finitePixel(b, x, y))
            std::copy_n(color.begin(), 3, &picture[3 * pixelIndex(a, x, y)]);
    }
  return picture;
}

EyeMetrics measureEye(const Image& result, const Image& truth, const Mask& mask, const Capture* capture) {
  const Surfaces surfaces = capture ? Surfaces(*capture) : Surfaces(truth.width, truth.height);
  EyeMetrics metrics;
  metrics.isolated = findIsolated(result, surfaces, mask).count;
  metrics.isolatedInTruth = findIsolated(truth, surfaces, mask).count;
  const SpotImage seen(result, surfaces, mask);
  std::optional<SpotImage> input;
  if (capture) input.emplace(litAlbedo(*capture), surfaces, mask);
  metrics.spots = seen.lackedBy(SpotImage(truth, surfaces, mask), seen.find(input ? &*input : nullptr)).size();
  metrics.tint = measureTint(result, truth, mask);
  metrics.flip = measureFlip(result, truth, mask);
  return metrics;
}

}  // namespace pellucid::harness
