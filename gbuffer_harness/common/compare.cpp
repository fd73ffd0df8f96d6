#include "common/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/error.h"

namespace pellucid::harness {

namespace {

// Samples of one channel.
struct Samples {
  std::vector<double> a, b;
};

double ratio(double numerator, double denominator) {
  if (numerator == 0) return 0;
  return denominator == 0 ? std::numeric_limits<double>::infinity() : numerator / denominator;
}

ChannelDifference difference(const Samples& samples) {
  const std::size_t count = samples.a.size();
  std::vector<double> absolute(count);
  double squares = 0, squaresB = 0, sumA = 0, sumB = 0;
  for (std::size_t i = 0; i < count; ++i) {
    absolute[i] = std::abs(samples.a[i] - samples.b[i]);
    squares += absolute[i] * absolute[i];
    squaresB += samples.b[i] * samples.b[i];
    sumA += samples.a[i];
    sumB += samples.b[i];
  }
  const double rmse = std::sqrt(squares / static_cast<double>(count));
  const double rmsB = std::sqrt(squaresB / static_cast<double>(count));
  // Nearest rank, counted from the top so that no product is rounded: 0.1 % of the samples may be above.
  const auto rank = absolute.end() - 1 - static_cast<std::ptrdiff_t>(count / 1000);
  std::nth_element(absolute.begin(), rank, absolute.end());
  const double p999 = *rank;
  const double max = *std::max_element(rank, absolute.end());
  const double peak = *std::max_element(samples.b.begin(), samples.b.end());

  ChannelDifference result;
  result.relativeRmse = ratio(rmse, rmsB);
  result.p999 = ratio(p999, rmsB);
  result.max = ratio(max, rmsB);
  result.psnr =
      rmse == 0 ? std::numeric_limits<double>::infinity() : 20 * std::log10(std::max(peak, 0.0) / rmse);
  result.bias = ratio(sumA - sumB, sumB);
  return result;
}

bool finite(const float* pixel, int channels) {
  return std::all_of(pixel, pixel + channels, [](float value) { return std::isfinite(value); });
}

}  // namespace

std::vector<std::uint8_t> comparisonMask(const std::vector<std::uint8_t>& material, const Image& irradiance,
                                         Subset subset) {
  std::vector<std::uint8_t> mask(material.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    bool counts = material[i] != 0;
    if (counts && subset != Subset::All) {
      const float* pixel = irradiance.data.data() + i * static_cast<std::size_t>(irradiance.channels);
      const bool lit = std::any_of(pixel, pixel + irradiance.channels, [](float value) { return value > 0; });
      counts = lit == (subset == Subset::Lit);
    }
    mask[i] = counts;
  }
  return mask;
}

Comparison compareImages(const Image& a, const Image& b, const std::vector<std::uint8_t>& mask, int box,
                         double coverage) {
  const auto size = [](const Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height);
  };
  if (a.width != b.width || a.height != b.height)
    throw InputError("", "size", "A has " + size(a) + " pixels and B has " + size(b));
  if (!mask.empty() && mask.size() != a.pixels())
    throw InputError("", "size",
                     "the mask has " + std::to_string(mask.size()) + " pixels and A has " + size(a));

  Comparison result;
  const int channels = std::min({a.channels, b.channels, 3});
  std::vector<Samples> samples(static_cast<std::size_t>(channels));
  for (int top = 0; top < a.height; top += box) {
    for (int left = 0; left < a.width; left += box) {
      const int bottom = std::min(top + box, a.height), right = std::min(left + box, a.width);
      double sumA[3] = {}, sumB[3] = {};
      int used = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const std::size_t index =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
          if (!mask.empty() && mask[index] == 0) continue;
          ++result.pixels;
          const bool finiteA = finite(a.at(x, y), channels), finiteB = finite(b.at(x, y), channels);
          result.nonFiniteA += !finiteA;
          result.nonFiniteB += !finiteB;
          if (!finiteA || !finiteB) continue;
          ++used;
          for (int c = 0; c < channels; ++c) {
            sumA[c] += a.at(x, y)[c];
            sumB[c] += b.at(x, y)[c];
          }
        }
      }
      if (used == 0 || used < coverage * ((bottom - top) * (right - left))) continue;
      ++result.samples;
      for (int c = 0; c < channels; ++c) {
        samples[static_cast<std::size_t>(c)].a.push_back(sumA[c] / used);
        samples[static_cast<std::size_t>(c)].b.push_back(sumB[c] / used);
      }
    }
  }
  if (result.samples == 0)
    throw InputError("", "mask",
                     std::to_string(result.pixels) + " pixels are in the mask (" +
                         std::to_string(result.nonFiniteA) + " not finite in A, " +
                         std::to_string(result.nonFiniteB) + " in B): nothing to compare");
  for (const Samples& channel : samples) result.channels.push_back(difference(channel));
  return result;
}

namespace {

// Calls block(left, top) for every block of box x box pixels that is wholly of mask.
template <class Block>
void forWholeBlocks(const Image& image, const std::vector<std::uint8_t>& mask, int box, const Block& block) {
  for (int top = 0; top + box <= image.height; top += box)
    for (int left = 0; left + box <= image.width; left += box) {
      bool whole = true;
      for (int y = top; y < top + box && whole; ++y)
        for (int x = left; x < left + box && whole; ++x)
          whole = mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x)] != 0;
      if (whole) block(left, top);
    }
}

// Sum over a block of power(value); 0 for no image.
template <class Power>
double blockSum(const Image& image, int left, int top, int box, int channel, const Power& power) {
  double sum = 0;
  if (image.empty()) return sum;
  for (int y = top; y < top + box; ++y)
    for (int x = left; x < left + box; ++x) sum += power(static_cast<double>(image.at(x, y)[channel]));
  return sum;
}

double itself(double x) { return x; }
double squared(double x) { return x * x; }

}  // namespace

std::vector<double> relativeNoise(const Image& image, const Image& standardError,
                                  const std::vector<std::uint8_t>& mask, int box) {
  std::vector<double> noise;
  for (int c = 0; c < image.channels; ++c) {
    double squares = 0, variance = 0;
    std::size_t blocks = 0;
    forWholeBlocks(image, mask, box, [&](int left, int top) {
      ++blocks;
      squares += squared(blockSum(image, left, top, box, c, itself));
      variance += blockSum(standardError, left, top, box, c, squared);
    });
    if (blocks == 0) return {};
    noise.push_back(std::sqrt(ratio(variance, squares)));
  }
  return noise;
}

}  // namespace pellucid::harness
