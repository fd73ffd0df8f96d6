// Small regions that stand out of their surface: spots.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/capture.h"
#include "metrics/masked_image.h"
#include "metrics/surface.h"

namespace pellucid::harness {

constexpr double kSpotContrast = 1.3;
constexpr int kLargestSpot = 5;  // pixels across, and from top to bottom

struct Spot {
  bool isBright = false;                           // else dark
  std::array<int, 2> low = {0, 0}, high = {0, 0};  // first and last column, row
  std::vector<std::array<int, 2>> pixels;          // x, y
};

// An image beside the medians of its surroundings. The surroundings of a pixel are the pixels of the 9x9
// around it that count and that steps over its surface reach within the 9x9.
class SpotImage {
public:
  // `image`: three channels of the surfaces' size; its pixels that do not count are in no surroundings.
  // Throws InputError for another size.
  SpotImage(const Image& image, const Surfaces& surfaces, const Mask& mask);

  // Regions of neighboring pixels of one surface that are at most kLargestSpot on both axes. Each pixel
  // stands out in some channel: it is kSpotContrast times above, or below, the median of its surroundings. It
  // is also kSpotContrast times above or below what `input` explains, the largest contrast of the same kind
  // in the 5x5 around it. And it differs from the median by 8 times the noise of the surroundings, which is
  // that of fine grain. `input`: what litAlbedo() gives; null: not known.
  // Pixels with less than half of the 9x9 around them are not judged. Values below kDarkestPart of the
  // channel's RMS count as this part.
  std::vector<Spot> find(const SpotImage* input) const;

  // The spots of this image that another one lacks: over their pixels, this image has kSpotContrast times the
  // contrast of the other in some channel. The sums over pixels average the noise of a path-traced truth.
  std::vector<Spot> lackedBy(const SpotImage& other, const std::vector<Spot>& spots) const;

private:
  using Color = std::array<float, 3>;
  struct Pixel {
    Color value = {}, median = {},
          noise = {};  // noise: standard deviation, of fine grain in the surroundings
    bool isJudged = false;
  };
  const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  bool standsOut(int x, int y, bool bright, const SpotImage* input) const;
  double explained(int x, int y, std::size_t channel, bool bright) const;
  double contrast(const Spot& spot, std::size_t channel) const;

  int width_, height_;
  std::vector<std::uint8_t> steps_;  // bit i: kSteps[i] stays on the surface, to a pixel that counts
  std::vector<Pixel> pixels_;
};

// The irradiance times the albedo, if there is any: a result without diffusion and translucency.
Image litAlbedo(const Capture& capture);

}  // namespace pellucid::harness
