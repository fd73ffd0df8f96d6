#include "metrics/isolated.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "common/png.h"

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

std::size_t IsolatedPixels::alone(const IsolatedPixels& other) const {
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) pixels += (marks[i] & ~other.marks[i]) != 0;
  return pixels;
}

IsolatedPixels findIsolated(const Image& image, const Surfaces& surfaces, const Mask& mask, double contrast) {
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
        if (value > seen && value > contrast * neighbors.largest[c]) mark |= kBright;
        if (neighbors.least[c] > seen && value * contrast < neighbors.least[c]) mark |= kDark;
      }
      result.bright += (mark & kBright) != 0;
      result.dark += (mark & kDark) != 0;
      result.count += mark != 0;
      result.marks[pixelIndex(image, x, y)] = mark;
    }
  return result;
}

std::vector<std::uint8_t> markIsolated(const Image& image, const IsolatedPixels& isolated, float exposure) {
  constexpr std::array<std::array<std::uint8_t, 3>, 4> kColors = {
      {{0, 0, 0}, {255, 40, 40}, {60, 120, 255}, {255, 40, 255}}};
  constexpr int kFrame = 2;  // pixels from the marked one, which stays visible with its neighbors
  std::vector<std::uint8_t> picture = toSrgb(image, exposure);
  for (std::uint8_t& value : picture) value /= 2;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t mark = isolated.marks[pixelIndex(image, x, y)];
      if (mark == 0) continue;
      for (int py = std::max(y - kFrame, 0); py <= std::min(y + kFrame, image.height - 1); ++py)
        for (int px = std::max(x - kFrame, 0); px <= std::min(x + kFrame, image.width - 1); ++px)
          if (std::max(std::abs(px - x), std::abs(py - y)) == kFrame)
            std::copy_n(kColors[mark].begin(), 3, &picture[3 * pixelIndex(image, px, py)]);
    }
  return picture;
}

}  // namespace pellucid::harness
