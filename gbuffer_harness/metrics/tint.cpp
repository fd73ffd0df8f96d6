#include "metrics/tint.h"

#include <cmath>
#include <limits>
#include <vector>

namespace pellucid::harness {

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

}  // namespace pellucid::harness
