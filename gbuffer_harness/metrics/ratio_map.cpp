#include "metrics/ratio_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid::harness {

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

}  // namespace pellucid::harness
