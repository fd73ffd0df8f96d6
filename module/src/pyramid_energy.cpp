#include "pyramid_energy.h"

#include <array>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

constexpr double kStep = EnergyFrom::kStep;
constexpr int kSamples = 49;

struct OfGaussian {
  double first;
  double samples[kSamples];
};
// As docs/diffusion.md says.
constexpr OfGaussian kOneFilter[kElements] = {
    {},
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
constexpr OfGaussian kTwoFilters[kElements] = {
    {-3,
     {0,      0.0008, 0.0025, 0.0065, 0.0149, 0.0303, 0.0552, 0.0925, 0.1451, 0.2124, 0.2926, 0.3828, 0.4805,
      0.5822, 0.6844, 0.7836, 0.8769, 0.9608, 1.032,  1.088,  1.129,  1.153,  1.164,  1.161,  1.148,  1.127,
      1.1,    1.071,  1.041,  1.02,   0.9977, 0.9825, 0.974,  0.9712, 0.9727, 0.977,  0.9826, 0.9884, 0.9934,
      0.9972, 0.9995, 1,      1,      0.9996, 0.9988, 0.9984, 0.9984, 0.9988, 1}},
    {-2.5, {0,       -0.0011, -0.0019, -0.0034, -0.0067, -0.0112, -0.0159, -0.0197, -0.0226, -0.024,
            -0.0228, -0.0179, -0.0078, 0.0098,  0.0375,  0.0778,  0.1317,  0.1993,  0.2786,  0.3684,
            0.4662,  0.5686,  0.672,   0.7728,  0.8675,  0.9351,  1.008,   1.063,   1.099,   1.119,
            1.124,   1.116,   1.1,     1.078,   1.053,   1.029,   1.007,   0.991,   0.9808,  0.9767,
            0.9774,  0.9815,  0.9872,  0.9929,  0.9975,  1.001,   1.002,   1.002,   1}},
    {-4, {0,       0.0007,  0.0014,  0.002,   0.0027,  0.0032,  0.0035,  0.0032,  0.0021,  0,
          -0.0046, -0.0112, -0.0203, -0.0313, -0.0431, -0.0549, -0.0652, -0.0721, -0.0732, -0.0661,
          -0.0485, -0.0251, 0.0212,  0.0848,  0.1645,  0.2576,  0.3614,  0.472,   0.5847,  0.6949,
          0.798,   0.8903,  0.9679,  1.028,   1.07,    1.093,   1.098,   1.088,   1.068,   1.043,
          1.017,   0.9949,  0.9789,  0.9709,  0.9704,  0.9753,  0.9827,  0.9904,  1}},
    {-4, {0,       0,       0,       0.0011,  0.0029, 0.0056,  0.009,   0.0129,  0.0172,  0.0209,
          0.0233,  0.023,   0.0189,  0.012,   -0.004, -0.0269, -0.0546, -0.0839, -0.1116, -0.1334,
          -0.1441, -0.1387, -0.1131, -0.0651, 0.0067, 0.1004,  0.2127,  0.3393,  0.4738,  0.6084,
          0.7347,  0.8452,  0.9352,  1.003,   1.048,  1.071,   1.075,   1.065,   1.047,   1.027,
          1.01,    0.9958,  0.9873,  0.9846,  0.9861, 0.9897,  0.9938,  0.9972,  1}},
    {-4 - kCoarserShift,
     {0,       0.0012,  0.0006,  0,       -0.0014, -0.0023, -0.0021, 0,       0.0044,  0.0112,
      0.0199,  0.0297,  0.0386,  0.044,   0.043,   0.0331,  0.0131,  -0.0153, -0.0485, -0.0822,
      -0.1101, -0.1246, -0.1176, -0.0824, -0.0161, 0.0784,  0.1958,  0.3298,  0.4718,  0.6115,
      0.7391,  0.8465,  0.9297,  0.9895,  1.028,   1.047,   1.051,   1.045,   1.034,   1.021,
      1.009,   0.9992,  0.9921,  0.9886,  0.9883,  0.9901,  0.9929,  0.9957,  1}},
};

// log2 of the narrowest and the widest Gaussian of Burley's profile at d = 1.
constexpr int kNarrowest = -11, kWidest = 4;
constexpr int kBurleySamples = kSamples + static_cast<int>((kWidest - kNarrowest) / kStep);

using OfBurley = std::array<double, kBurleySamples>;

// e^{-r/a} / (2 pi a r) is a mixture of Gaussians whose deviations s have the density
// sqrt(2 / pi) / a e^{-s^2 / (2 a^2)}, as e^{-r/a} / r = 2 / sqrt(pi) int_0^inf e^{-r^2 t^2 - 1 / (4 a^2
// t^2)} dt with t^2 = 1 / (2 s^2). Burley's is a quarter of that with a = d and three of a = 3 d.
OfBurley ofBurley(const OfGaussian& gaussian) {
  constexpr int kGaussians = kBurleySamples - kSamples;
  std::array<double, kGaussians> weight;
  double sum = 0;
  for (int i = 0; i < kGaussians; ++i) {
    // Widest first, times s, as they are at equal steps of log2 s.
    const double s = std::exp2(kWidest - kStep * i);
    weight[i] = s / 4 * (std::exp(-s * s / 2) + std::exp(-s * s / 18));
    sum += weight[i];
  }
  OfBurley result{};
  for (int at = 0; at < kBurleySamples; ++at)
    for (int i = 0; i < kGaussians; ++i) {
      const int sample = at - i;
      if (sample >= 0) result[at] += weight[i] / sum * (sample < kSamples ? gaussian.samples[sample] : 1);
    }
  return result;
}

const OfGaussian& tableOf(FineFilters filters, Element element) {
  return (filters == FineFilters::TwoOfPlanes ? kTwoFilters : kOneFilter)[element];
}

}  // namespace

EnergyFrom gaussianEnergy(FineFilters filters, Element element) {
  const OfGaussian& table = tableOf(filters, element);
  return {table.first, table.samples};
}

EnergyFrom burleyEnergy(FineFilters filters, Element element) {
  static const auto tables = [] {
    std::array<std::array<OfBurley, kElements>, 2> all;
    for (int i = 0; i < kElements; ++i) {
      all[0][i] = ofBurley(kOneFilter[i]);
      all[1][i] = ofBurley(kTwoFilters[i]);
    }
    return all;
  }();
  return {tableOf(filters, element).first - kWidest, tables[filters == FineFilters::TwoOfPlanes][element]};
}

}  // namespace pellucid
