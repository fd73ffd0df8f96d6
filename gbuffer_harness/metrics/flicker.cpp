#include "metrics/flicker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/compare.h"
#include "reference/camera.h"

namespace pellucid::harness {

namespace {

constexpr int kSurroundings = 2;  // pixels to either side: 5x5

// Mean of three channels over the pixels around (x, y) that count, which (x, y) does.
std::array<double, 3> meanAround(const Image& image, const Mask& mask, int x, int y) {
  return blockMeans(image, image, mask, x - kSurroundings, y - kSurroundings, 2 * kSurroundings + 1).a;
}

// Statistics of the difference d, where `mask` says that there is one.
Flicker measure(const Image& still, const Image& d, const Mask& mask, const Mask& differences) {
  Flicker flicker;
  const std::array<double, 3> rms = rmsOf(still, mask), rmsOfD = rmsOf(d, differences);
  std::array<std::vector<double>, 3> relative;
  double largest = -1;
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      if (differences[pixelIndex(d, x, y)] == 0) continue;
      const std::array<double, 3> mean = meanAround(still, mask, x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = std::abs(static_cast<double>(d.at(x, y)[c]));
        const double value = difference == 0 ? 0 : difference / std::max(mean[c], kDarkestPart * rms[c]);
        relative[c].push_back(value);
        if (value > largest) {
          largest = value;
          flicker.worstPixel = {x, y};
        }
      }
    }
  flicker.pixels = relative[0].size();
  if (flicker.pixels == 0) return flicker;
  for (std::size_t c = 0; c < 3; ++c) {
    flicker.relativeRmse[c] = rmsOfD[c] == 0 ? 0 : rmsOfD[c] / rms[c];
    std::vector<double>& values = relative[c];
    const auto rank = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / 1000);
    std::nth_element(values.begin(), rank, values.end());
    flicker.p999[c] = *rank;
    flicker.worst[c] = *std::max_element(rank, values.end());
  }
  return flicker;
}

}  // namespace

Flicker compareShifted(const Image& still, const Image& moved, const Mask& mask, int shiftX, int shiftY) {
  requireImage("still frame", still, still.width, still.height, mask);
  requireImage("moved frame", moved, still.width, still.height, mask);
  Image d(still.width, still.height, 3);
  Mask differences(mask.size());
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      const int movedX = x + shiftX, movedY = y + shiftY;
      if (movedX < 0 || movedY < 0 || movedX >= still.width || movedY >= still.height) continue;
      if (!counts(still, mask, x, y) || !finitePixel(moved, movedX, movedY)) continue;
      differences[pixelIndex(d, x, y)] = 1;
      for (int c = 0; c < 3; ++c) d.at(x, y)[c] = moved.at(movedX, movedY)[c] - still.at(x, y)[c];
    }
  return measure(still, d, mask, differences);
}

namespace {

// Statistics of the difference less its mean over the 5x5 pixels around, where all of these are of one
// surface and of `both`, over `base`, of whose pixels `mask` counts.
Flicker measureUneven(const Image& before, const Image& after, const Surfaces& surfaces, const Mask& both,
                      const Image& base, const Mask& mask) {
  constexpr int kSide = 2 * kSurroundings + 1;
  Image d(base.width, base.height, 3);
  Mask differences(mask.size());
  for (int y = 0; y < base.height; ++y)
    for (int x = 0; x < base.width; ++x) {
      const int left = x - kSurroundings, top = y - kSurroundings;
      if (!surfaces.wholeBlock(left, top, kSide)) continue;
      const BlockMeans means = blockMeans(after, before, both, left, top, kSide);
      if (means.pixels < kSide * kSide) continue;
      differences[pixelIndex(d, x, y)] = 1;
      for (std::size_t c = 0; c < 3; ++c)
        d.at(x, y)[c] = static_cast<float>(static_cast<double>(after.at(x, y)[c]) - before.at(x, y)[c] -
                                           (means.a[c] - means.b[c]));
    }
  return measure(base, d, mask, differences);
}

}  // namespace

Flicker compareTurned(const Image& still, const Image& turned, const Surfaces& surfaces, const Mask& mask) {
  requireImage("still frame", still, surfaces.width(), surfaces.height(), mask);
  requireImage("turned frame", turned, still.width, still.height, mask);
  return measureUneven(still, turned, surfaces, mask, still, mask);
}

Reprojection::Reprojection(const Capture& earlier, const Capture& later)
    : earlier_(earlier),
      later_(later),
      earlierSurfaces_(earlier),
      laterSurfaces_(later),
      motion_(later, earlier.clipFromView, earlier.viewFromWorld) {}

std::optional<std::array<double, 3>> Reprojection::read(const Image& image, int x, int y) const {
  const std::optional<glm::dvec3> place = motion_.earlierPlace(x, y);
  if (!place) return std::nullopt;
  const reference::Camera& camera = motion_.earlierCamera();
  const double planar = camera.planarDepth(*place);
  const glm::dvec2 at = camera.project(*place) - 0.5;
  // Also where `at` is no number.
  if (!(at.x >= 0 && at.y >= 0 && at.x < image.width - 1 && at.y < image.height - 1)) return std::nullopt;
  const int left = static_cast<int>(at.x), top = static_cast<int>(at.y);
  if (!earlierSurfaces_.wholeBlock(left, top, 2)) return std::nullopt;
  const glm::dvec2 part = at - glm::floor(at);
  std::array<double, 3> sum = {};
  double shown = 0;
  for (int i = 0; i < 4; ++i) {
    const int px = left + i % 2, py = top + i / 2;
    const double weight = (i % 2 ? part.x : 1 - part.x) * (i / 2 ? part.y : 1 - part.y);
    // The block is wholly of surface: there is a depth.
    shown +=
        weight * *camera.planarDepth(*earlier_.frontDepth.image.at(px, py), earlier_.frontDepth.encoding);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(image.at(px, py)[c]);
  }
  // Another surface hides the place from the earlier camera.
  constexpr double kSameDistance = 0.005;
  if (!(std::abs(shown - planar) <= kSameDistance * std::abs(planar))) return std::nullopt;
  return sum;
}

Flicker Reprojection::compare(const Image& earlier, const Image& later) const {
  const Mask mask = comparisonMask(later_.material, later_.irradiance, Subset::All);
  requireImage("later frame", later, later_.width, later_.height, mask);
  requireImage("earlier frame", earlier, earlier_.width, earlier_.height,
               comparisonMask(earlier_.material, earlier_.irradiance, Subset::All));
  Image before(later_.width, later_.height, 3);
  Mask seen(mask.size());
  for (int y = 0; y < later_.height; ++y)
    for (int x = 0; x < later_.width; ++x) {
      if (!counts(later, mask, x, y)) continue;
      const auto value = read(earlier, x, y);
      if (!value) continue;
      for (std::size_t c = 0; c < 3; ++c) before.at(x, y)[c] = static_cast<float>((*value)[c]);
      seen[pixelIndex(before, x, y)] = 1;
    }
  return measureUneven(before, later, laterSurfaces_, seen, later, mask);
}

std::vector<Flicker> PathFlicker::next(Capture capture, bool switches, const Render& render) {
  std::optional<Reprojection> reprojection;
  if (last_) {
    reprojection.emplace(*last_, capture);
    capture.motion = reprojection->motion();
  }
  std::vector<Image> images = render(capture);
  std::vector<Flicker> flicker;
  for (std::size_t i = 0; i < images.size() && reprojection && !switches; ++i)
    flicker.push_back(reprojection->compare(images_[i], images[i]));
  images_ = std::move(images);
  last_ = std::move(capture);
  return flicker;
}

Flicker flickerOf(const std::vector<Flicker>& steps) {
  Flicker all;
  double largest = -1;
  for (const Flicker& step : steps)
    for (std::size_t c = 0; c < 3; ++c) {
      all.pixels = std::max(all.pixels, step.pixels);
      all.relativeRmse[c] += step.relativeRmse[c] / static_cast<double>(steps.size());
      all.p999[c] = std::max(all.p999[c], step.p999[c]);
      all.worst[c] = std::max(all.worst[c], step.worst[c]);
      if (step.worst[c] <= largest) continue;
      largest = step.worst[c];
      all.worstPixel = step.worstPixel;
    }
  return all;
}

SpotFlicker compareSpots(const SpotImage& still, const SpotImage& stillInput, const SpotImage& turned,
                         const SpotImage& turnedInput) {
  const std::vector<Spot> ofStill = still.find(&stillInput), ofTurned = turned.find(&turnedInput);
  return {ofStill.size(), ofTurned.size(), turned.lackedBy(still, ofTurned).size(),
          still.lackedBy(turned, ofStill).size()};
}

}  // namespace pellucid::harness
