#include "pyramid_energy.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace pellucid {
namespace {

constexpr double kStep = EnergyFrom::kStep;
constexpr int kSamples = 49;

struct OfGaussian {
  double first;
  double samples[kSamples];
};
// As docs/diffusion.md says.
constexpr OfGaussian kTable[kElements] = {
    {-3, {0,      0,      0.0006638, 0.003575, 0.009764, 0.02009, 0.03606, 0.05961, 0.09098, 0.1304,
          0.175,  0.2248, 0.2839,    0.3504,   0.4224,   0.4982,  0.5799,  0.6655,  0.7515,  0.8292,
          0.8968, 0.9569, 1.012,     1.06,     1.104,    1.14,    1.166,   1.177,   1.177,   1.167,
          1.154,  1.136,  1.118,     1.097,    1.075,    1.052,   1.033,   1.018,   1.01,    1.006,
          1.005,  1.004,  1.003,     1.002,    1.001,    1.001,   1,       1,       1}},
    {-4,
     {0,        -0.001361, -0.003499, 0.01817,  0.005962,  0.008113, 0.001908, 0.009758, 0.001368, -0.008796,
      -0.03024, -0.04052,  -0.02883,  -0.01623, -0.004877, 0.002425, 0.0169,   0.04507,  0.08557,  0.1484,
      0.2295,   0.3219,    0.4223,    0.5227,   0.6177,    0.7089,   0.7965,   0.876,    0.9449,   0.9977,
      1.031,    1.046,     1.049,     1.046,    1.04,      1.032,    1.022,    1.013,    1.007,    1.006,
      1.006,    1.005,     1.004,     1.002,    1.001,     1,        0.9998,   0.9998,   1}},
    {-4,
     {0,        -0.008264, -0.001188, -0.01123, 0,        0.0007493, 0.00718,  0.03786,  0.03136,  0.03061,
      0.02214,  0.02143,   0.006304,  -0.02053, -0.05872, -0.08738,  -0.09185, -0.08449, -0.06675, -0.03891,
      0.003059, 0.06459,   0.1444,    0.2538,   0.3818,   0.5117,    0.639,    0.7576,   0.8639,   0.9514,
      1.014,    1.05,      1.065,     1.066,    1.057,    1.043,     1.025,    1.011,    1.004,    1.004,
      1.008,    1.01,      1.01,      1.006,    1.002,    0.9985,    0.9972,   0.9981,   1}},
    {-4 - kCoarserShift,
     {0,        -0.006975, 0.006749, -0.01058, -0.00107,  -0.0005165, -0.002841, 0.008785, 0.002845,
      0.01759,  0.002336,  0.01514,  0.003296, -0.002201, -0.003651,  -0.019,    -0.02866, -0.04148,
      -0.04129, -0.03652,  -0.01229, 0.03441,  0.1036,    0.2021,     0.3185,    0.4456,   0.5802,
      0.7123,   0.8367,    0.9352,   1.002,    1.039,     1.054,      1.056,     1.049,    1.035,
      1.02,     1.008,     1.004,    1.008,    1.014,     1.017,      1.017,     1.013,    1.007,
      1.002,    0.9992,    0.9988,   1}},
};
// log2 of the narrowest and the widest Gaussian of Burley's profile at d = 1.
constexpr int kNarrowest = -11, kWidest = 4;
constexpr int kBurleySamples = kSamples + static_cast<int>((kWidest - kNarrowest) / kStep);

using Mixture = std::array<double, kBurleySamples>;

// e^{-r/a} / (2 pi a r) is a mixture of Gaussians whose deviations s have the density
// sqrt(2 / pi) / a e^{-s^2 / (2 a^2)}, as e^{-r/a} / r = 2 / sqrt(pi) int_0^inf e^{-r^2 t^2 - 1 / (4 a^2
// t^2)} dt with t^2 = 1 / (2 s^2). Burley's is a quarter of that with a = d and three of a = 3 d.
Mixture mixtureOf(const OfGaussian& gaussian) {
  constexpr int kGaussians = kBurleySamples - kSamples;
  std::array<double, kGaussians> weight;
  double sum = 0;
  for (int i = 0; i < kGaussians; ++i) {
    // Widest first, times s, as they are at equal steps of log2 s.
    const double s = std::exp2(kWidest - kStep * i);
    weight[i] = s / 4 * (std::exp(-s * s / 2) + std::exp(-s * s / 18));
    sum += weight[i];
  }
  Mixture result{};
  for (int at = 0; at < kBurleySamples; ++at)
    for (int i = 0; i < kGaussians; ++i) {
      const int sample = at - i;
      if (sample >= 0) result[at] += weight[i] / sum * (sample < kSamples ? gaussian.samples[sample] : 1);
    }
  return result;
}

}  // namespace

EnergyFrom gaussianEnergy(Element element) { return {kTable[element].first, kTable[element].samples}; }

EnergyFrom burleyEnergy(Element element) {
  static const auto mixtures = [] {
    std::array<Mixture, kElements> all;
    for (int i = 0; i < kElements; ++i) all[i] = mixtureOf(kTable[i]);
    return all;
  }();
  return {kTable[element].first - kWidest, mixtures[element]};
}

}  // namespace pellucid
