#include "metrics/flicker.h"

#include <algorithm>
#include <cmath>

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

Flicker compareTurned(const Image& still, const Image& turned, const Surfaces& surfaces, const Mask& mask) {
  requireImage("still frame", still, surfaces.width(), surfaces.height(), mask);
  requireImage("turned frame", turned, still.width, still.height, mask);
  constexpr int kSide = 2 * kSurroundings + 1;
  Image d(still.width, still.height, 3);
  Mask differences(mask.size());
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      const int left = x - kSurroundings, top = y - kSurroundings;
      if (!surfaces.wholeBlock(left, top, kSide)) continue;
      const BlockMeans means = blockMeans(turned, still, mask, left, top, kSide);
      if (means.pixels < kSide * kSide) continue;
      differences[pixelIndex(d, x, y)] = 1;
      for (std::size_t c = 0; c < 3; ++c)
        d.at(x, y)[c] = static_cast<float>(static_cast<double>(turned.at(x, y)[c]) - still.at(x, y)[c] -
                                           (means.a[c] - means.b[c]));
    }
  return measure(still, d, mask, differences);
}

SpotFlicker compareSpots(const SpotImage& still, const SpotImage& stillInput, const SpotImage& turned,
                         const SpotImage& turnedInput) {
  const std::vector<Spot> ofStill = still.find(&stillInput), ofTurned = turned.find(&turnedInput);
  return {ofStill.size(), ofTurned.size(), turned.lackedBy(still, ofTurned).size(),
          still.lackedBy(turned, ofStill).size()};
}

}  // namespace pellucid::harness
