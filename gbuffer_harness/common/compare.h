// How far one image is from another, per channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/image.h"

namespace pellucid::harness {

// Which pixels count, by the light that reaches them from the front.
enum class Subset {
  All,
  Lit,    // some channel of the irradiance is above 0
  Unlit,  // none is: what is seen there came through the object or along it
};

// 1 where a pixel counts: material not 0 and in the subset. `irradiance` is not looked at for All.
std::vector<std::uint8_t> comparisonMask(const std::vector<std::uint8_t>& material, const Image& irradiance,
                                         Subset subset);

// One channel of A against B over the samples; RMS(B) is the root of the mean of B^2 over them.
struct ChannelDifference {
  double relativeRmse;  // sqrt(mean (A - B)^2) / RMS(B)
  double p999;          // of |A - B| / RMS(B): 99.9 % of the samples are at or below (nearest rank)
  double max;           // of |A - B| / RMS(B)
  double psnr;          // dB: 20 log10(max B / sqrt(mean (A - B)^2)); infinite for equal images
  double bias;          // mean A / mean B - 1
};

struct Comparison {
  std::vector<ChannelDifference> channels;
  std::size_t pixels = 0;                      // in the mask
  std::size_t samples = 0;                     // pixels, or blocks, that the numbers are made of
  std::size_t nonFiniteA = 0, nonFiniteB = 0;  // masked pixels with a NaN or infinity; left out
};

// Pixels a side of the averages in which results are compared with a truth: the noise of a pixel averages out.
inline constexpr int kTruthBox = 4;

// Compares the channels that both images have, at most three. `mask`: one value per pixel, 0 leaves it
// out; empty: all pixels. box > 1: a sample is the mean over the masked pixels of a box x box block,
// blocks counted from pixel (0, 0); blocks of whose pixels (those inside the image) less than the part
// `coverage` is left, or none, are not samples. Dividing by an RMS(B) or mean of 0 gives 0 for equal
// channels, else infinity. Throws InputError when the sizes differ or no sample is left.
Comparison compareImages(const Image& a, const Image& b, const std::vector<std::uint8_t>& mask, int box = 1,
                         double coverage = 0.5);

// Noise of an image, R G B: the root mean square of the standard errors of its samples over that of the
// samples themselves. Samples are blocks wholly of mask, of box x box pixels whose errors are independent,
// counted from pixel (0, 0). Empty without such a block; a channel that is 0 everywhere has no noise.
std::vector<double> relativeNoise(const Image& image, const Image& standardError,
                                  const std::vector<std::uint8_t>& mask, int box);

}  // namespace pellucid::harness
