#include "metrics/masked_image.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.h"

namespace pellucid::harness {

bool finitePixel(const Image& image, int x, int y) {
  const float* pixel = image.at(x, y);
  return std::all_of(pixel, pixel + 3, [](float value) { return std::isfinite(value); });
}

std::array<double, 3> rmsOf(const Image& image, const Mask& mask) {
  std::array<double, 3> squares = {};
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!counts(image, mask, x, y)) continue;
      ++count;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = image.at(x, y)[c];
        squares[c] += value * value;
      }
    }
  for (double& value : squares) value = count ? std::sqrt(value / static_cast<double>(count)) : 0;
  return squares;
}

BlockMeans blockMeans(const Image& a, const Image& b, const Mask& mask, int left, int top, int side) {
  BlockMeans means;
  for (int y = std::max(top, 0); y < std::min(top + side, a.height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + side, a.width); ++x) {
      if (!counts(a, mask, x, y) || !finitePixel(b, x, y)) continue;
      ++means.pixels;
      for (std::size_t c = 0; c < 3; ++c) {
        means.a[c] += a.at(x, y)[c];
        means.b[c] += b.at(x, y)[c];
      }
    }
  for (std::size_t c = 0; c < 3 && means.pixels > 0; ++c) {
    means.a[c] /= means.pixels;
    means.b[c] /= means.pixels;
  }
  return means;
}

void requireImage(const char* what, const Image& image, int width, int height, const Mask& mask) {
  const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
  if (image.width != width || image.height != height || image.channels != 3)
    throw InputError("", what,
                     size(image.width, image.height) + " pixels of " + std::to_string(image.channels) +
                         " channels; need " + size(width, height) + " of 3");
  if (mask.size() != image.pixels())
    throw InputError(
        "", "mask",
        std::to_string(mask.size()) + " pixels; " + what + " has " + size(image.width, image.height));
}

}  // namespace pellucid::harness
