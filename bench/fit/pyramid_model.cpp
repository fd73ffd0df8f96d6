#include "fit/pyramid_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shared/pellucid_filters.h"

namespace pellucid::fit {
namespace {

constexpr std::array kDownsample = {PELLUCID_DOWNSAMPLE_OUTER, PELLUCID_DOWNSAMPLE_INNER,
                                    PELLUCID_DOWNSAMPLE_INNER, PELLUCID_DOWNSAMPLE_OUTER};
constexpr std::array kFine = {PELLUCID_FINE_LAST, PELLUCID_FINE_NEXT, PELLUCID_FINE_OWN, PELLUCID_FINE_NEXT,
                              PELLUCID_FINE_LAST};

int floorHalf(int i) { return (i - (i & 1)) / 2; }

// Weights of the finer level's texels: texel i averages texels 2 i - 1 to 2 i + 2 of it.
Kernel throughDownsampling(const Kernel& coarser) {
  Kernel finer{2 * coarser.first - 1, std::vector<double>(2 * coarser.weights.size() + 2)};
  for (size_t i = 0; i < coarser.weights.size(); ++i)
    for (size_t k = 0; k < kDownsample.size(); ++k)
      finer.weights[2 * i + k] += coarser.weights[i] * kDownsample[k];
  return finer;
}

// Weights of pixels: texel i of level 1 averages pixels 2 i and 2 i + 1.
Kernel throughBaseLevel(const Kernel& level1) {
  Kernel pixels{2 * level1.first, {}};
  for (const double w : level1.weights) pixels.weights.insert(pixels.weights.end(), {w / 2, w / 2});
  return pixels;
}

// Weights of the coarser level's texels: texel i takes the one that it lies in and the one beside it that is
// nearer.
Kernel throughRefinement(const Kernel& finer) {
  const int last = finer.first + static_cast<int>(finer.weights.size()) - 1;
  Kernel coarser{floorHalf(finer.first) - 1, {}};
  coarser.weights.resize(static_cast<size_t>(floorHalf(last) + 2 - coarser.first));
  for (size_t k = 0; k < finer.weights.size(); ++k) {
    const int i = finer.first + static_cast<int>(k), near = floorHalf(i),
              far = (i & 1) != 0 ? near + 1 : near - 1;
    coarser.weights[static_cast<size_t>(near - coarser.first)] += finer.weights[k] * PELLUCID_REFINEMENT_NEAR;
    coarser.weights[static_cast<size_t>(far - coarser.first)] += finer.weights[k] * PELLUCID_REFINEMENT_FAR;
  }
  return coarser;
}

// Weights of level 2's texels at a pixel: the quadratic B-spline.
Kernel lastInterpolation(int pixel) {
  const int texel = floorHalf(floorHalf(pixel));
  const double at = (pixel - 4 * texel - 1.5) / 4;
  return {texel - 1, {(0.5 - at) * (0.5 - at) / 2, 0.75 - at * at, (0.5 + at) * (0.5 + at) / 2}};
}

}  // namespace

Kernel elementKernel(int element, int phase) {
  if (element == kPixel) return {0, {1}};
  if (element == kFineFilter) return {-2, {kFine.begin(), kFine.end()}};
  Kernel kernel = lastInterpolation(phase);
  for (int level = kFirstLevelElement; level < element; ++level) kernel = throughRefinement(kernel);
  for (int level = element; level > 1; --level) kernel = throughDownsampling(kernel);
  kernel = throughBaseLevel(kernel);
  kernel.first -= phase;
  return kernel;
}

double varianceOf(const Kernel& kernel) {
  double sum = 0;
  for (size_t i = 0; i < kernel.weights.size(); ++i) {
    const double x = kernel.first + static_cast<double>(i);
    sum += kernel.weights[i] * x * x;
  }
  return sum;
}

Kernel gaussianKernel(double deviation, int reach) {
  Kernel kernel{-reach, {}};
  const double scale = 1 / (deviation * std::numbers::sqrt2);
  for (int i = -reach; i <= reach; ++i) {
    // The outer half alone says it, as differences of numbers near 1 would have no digits left.
    const double from = std::abs(i) - 0.5, to = std::abs(i) + 0.5;
    kernel.weights.push_back((std::erfc(from * scale) - std::erfc(to * scale)) / 2);
  }
  return kernel;
}

}  // namespace pellucid::fit
