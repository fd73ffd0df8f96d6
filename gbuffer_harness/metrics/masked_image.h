// Pixels that count, and sums over them: what the metrics have in common.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/image.h"

namespace pellucid::harness {

using Mask = std::vector<std::uint8_t>;  // one value a pixel, row 0 first; 0: does not count

// Values below this part of the RMS are too dark for the eye to judge ratios of.
inline constexpr double kDarkestPart = 0.02;

inline std::size_t pixelIndex(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

// True when the first three channels, or those there are, hold numbers.
bool finitePixel(const Image& image, int x, int y);

// True when the pixel is in the mask and finite.
inline bool counts(const Image& image, const Mask& mask, int x, int y) {
  return mask[pixelIndex(image, x, y)] != 0 && finitePixel(image, x, y);
}

// Root of the mean square of each of three channels over the pixels that count; 0 without any.
std::array<double, 3> rmsOf(const Image& image, const Mask& mask);

// Means of two images over the pixels of a block that count in both.
struct BlockMeans {
  std::array<double, 3> a = {}, b = {};
  int pixels = 0;  // that the means are of; 0: a and b are 0
};
// Three channels. Pixels of the block that lie outside of the images are left out.
BlockMeans blockMeans(const Image& a, const Image& b, const Mask& mask, int left, int top, int side);

// Throws InputError, naming `what`, unless the image has three channels of that size and the mask as many
// pixels.
void requireImage(const char* what, const Image& image, int width, int height, const Mask& mask);

}  // namespace pellucid::harness
