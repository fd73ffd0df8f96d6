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
     {0,      0.0007, 0.0023, 0.0061, 0.0141, 0.029,  0.0534, 0.0899, 0.14,   0.2041, 0.2816, 0.3698, 0.4653,
      0.5645, 0.664,  0.7604, 0.8505, 0.9322, 1.0032, 1.0623, 1.1077, 1.1394, 1.1572, 1.161,  1.1509, 1.1284,
      1.0975, 1.0642, 1.0343, 1.0117, 0.9973, 0.9889, 0.9856, 0.9855, 0.9872, 0.9898, 0.9925, 0.995,  0.9971,
      0.9987, 0.9999, 1.0004, 1.0006, 1.0006, 1.0005, 1.0003, 1.0002, 1,      1}},
    {-2.5, {0,       -0.0008, -0.0031, -0.0081, -0.0175, -0.0262, -0.0366, -0.0481, -0.0595, -0.0694,
            -0.0766, -0.0795, -0.076,  -0.064,  -0.0412, -0.0056, 0.0456,  0.1123,  0.1942,  0.2903,
            0.3987,  0.5159,  0.6361,  0.7518,  0.8554,  0.9417,  1.0082,  1.0594,  1.0941,  1.114,
            1.1211,  1.1175,  1.1048,  1.0849,  1.0597,  1.0315,  1.0044,  0.9871,  0.9745,  0.9675,
            0.9664,  0.9707,  0.979,   0.9893,  0.9986,  1.0037,  1.0065,  1.0071,  1}},
    {-4, {0,       0.001,   0.0031,  0.0067,  0.012,   0.015,   0.0173,  0.0185,  0.0179,  0.0149,
          0.0089,  -0.0007, -0.0151, -0.0333, -0.0545, -0.0771, -0.0989, -0.1171, -0.1273, -0.1249,
          -0.1051, -0.0647, -0.0029, 0.0741,  0.1667,  0.2717,  0.3846,  0.5008,  0.6155,  0.7243,
          0.8235,  0.9104,  0.9803,  1.0235,  1.0509,  1.0641,  1.0654,  1.057,   1.0416,  1.0221,
          1.0033,  0.9913,  0.9831,  0.9789,  0.9785,  0.9813,  0.9864,  0.9928,  1}},
    {-4, {0,       -0.0008, -0.001,  0.0003,  0.0057, 0.0133,  0.0229,  0.0338,  0.045,   0.0549,
          0.0612,  0.0614,  0.0529,  0.034,   0.0047, -0.0276, -0.0633, -0.0992, -0.1306, -0.1525,
          -0.1602, -0.1496, -0.1177, -0.0633, 0.0163, 0.1292,  0.2578,  0.395,   0.5334,  0.666,
          0.7868,  0.8916,  0.9745,  1.0262,  1.0581, 1.0732,  1.0746,  1.0652,  1.0481,  1.0261,
          1.0042,  0.9992,  0.9983,  0.9984,  0.9993, 1.0003,  1.0007,  0.9999,  1}},
    {-4, {0,       -0.0025, -0.0065, -0.0111, -0.0142, -0.0101, -0.0016, 0.0111,  0.0268, 0.0436,
          0.0591,  0.0709,  0.0764,  0.06,    0.03,    0,       0,       -0.0405, -0.081, -0.1149,
          -0.1352, -0.1355, -0.1112, -0.0603, 0.0195,  0.1334,  0.264,   0.4029,  0.5418, 0.6736,
          0.7924,  0.8945,  0.9748,  1.0142,  1.034,   1.0416,  1.0406,  1.034,   1.0245, 1.0141,
          1.0049,  1.0011,  0.9996,  0.9992,  0.9994,  0.9999,  1.0003,  1.0005,  1}},
};

// Of Burley's profile with d = 1 in the same units, fitted as a whole with no level below 0, which Gaussians
// between two levels ask for. From the last sample on what lies beyond `radius`.
// Levels 2 and 3 on have more than the fit says, of what finer ones have where that is less than .4 up to a
// hundredth and a fiftieth: checkers much smaller than the radius kept .7 % too much of their contrast.
struct OfBurley {
  static constexpr int kFitted = 61;
  double first;
  double radius;
  double samples[kFitted];
};
constexpr OfBurley kTwoFiltersOfBurley[kElements] = {
    {-5.5, 0.275, {0,      0.0006, 0.0012, 0.0021, 0.0035, 0.0056, 0.0087, 0.013,  0.0189, 0.0266, 0.0365,
                   0.0487, 0.0634, 0.0807, 0.1008, 0.1235, 0.1489, 0.1766, 0.2065, 0.2384, 0.2718, 0.3065,
                   0.3421, 0.3781, 0.4148, 0.4517, 0.4878, 0.5226, 0.5556, 0.5864, 0.6144, 0.6399, 0.6635,
                   0.6878, 0.7102, 0.7305, 0.7494, 0.7674, 0.7848, 0.8018, 0.8188, 0.8347, 0.8493, 0.8619,
                   0.8736, 0.8842, 0.8939, 0.9025, 0.9102, 0.9171, 0.9232, 0.9286, 0.9336, 0.9382, 0.9427,
                   0.9471, 0.9515, 0.9559, 0.9599, 0.9633, 0.9664}},
    {-5, 0.818, {0,       -0.0006, -0.0009, -0.0014, -0.0021, -0.0031, -0.0043, -0.0058, -0.0075,
                 -0.0093, -0.0111, -0.0128, -0.0141, -0.0149, -0.0149, -0.0138, -0.0113, -0.0069,
                 -0.0005, 0.0083,  0.0187,  0.0314,  0.0473,  0.0668,  0.0902,  0.1177,  0.1497,
                 0.1854,  0.2233,  0.2589,  0.2958,  0.3343,  0.3727,  0.4101,  0.446,   0.4795,
                 0.5104,  0.5399,  0.5688,  0.5979,  0.6258,  0.6524,  0.6779,  0.7023,  0.7257,
                 0.7479,  0.769,   0.7889,  0.8074,  0.8244,  0.8397,  0.8532,  0.8651,  0.8755,
                 0.8851,  0.8945,  0.9031,  0.9106,  0.9178,  0.9247,  0.9311}},
    {-6.5, 0.585, {0,      0.0004, 0.0007, 0.001,  0.0014, 0.0018, 0.0023, 0.0027, 0.003,  0.0033, 0.0033,
                   0.0032, 0.0029, 0.0023, 0.0015, 0.0005, 0,      0,      0,      0,      0,      0,
                   0,      0.0005, 0.0024, 0.0102, 0.0204, 0.0324, 0.0476, 0.0663, 0.0888, 0.1153, 0.1457,
                   0.1782, 0.2116, 0.2445, 0.2781, 0.312,  0.346,  0.3796, 0.4127, 0.445,  0.4765, 0.5072,
                   0.5371, 0.5662, 0.5947, 0.6231, 0.6507, 0.6773, 0.7025, 0.7254, 0.7469, 0.7673, 0.786,
                   0.803,  0.8187, 0.832,  0.8445, 0.8562, 0.867}},
    {-6.5, 0.628, {0,      0,      0,      0,      0,      0,      0,      0,      0,      0,      0,
                   0,      0,      0,      0,      0,      0,      0,      0,      0,      0,      0,
                   0,      0,      0.0001, 0.0019, 0.0074, 0.0184, 0.0327, 0.0504, 0.0715, 0.0957, 0.1229,
                   0.1525, 0.1842, 0.2173, 0.2514, 0.2857, 0.3196, 0.3526, 0.3847, 0.4159, 0.4471, 0.4792,
                   0.5107, 0.5409, 0.5707, 0.6001, 0.6292, 0.6573, 0.6839, 0.7081, 0.7308, 0.7524, 0.7723,
                   0.7903, 0.8069, 0.8211, 0.8345, 0.8468, 0.8584}},
    {-6.5, 0.624, {0,      0,      0,      0,      0,      0,      0,      0,      0,      0,      0,
                   0,      0,      0,      0,      0,      0,      0,      0,      0,      0,      0,
                   0.001,  0.0023, 0.0052, 0.0101, 0.0174, 0.0277, 0.0413, 0.0585, 0.0798, 0.1054, 0.1344,
                   0.1664, 0.1993, 0.2309, 0.2633, 0.297,  0.3302, 0.3625, 0.3946, 0.4271, 0.4588, 0.4898,
                   0.52,   0.5497, 0.5787, 0.6073, 0.6353, 0.6624, 0.6881, 0.7116, 0.7337, 0.7547, 0.7741,
                   0.7918, 0.8081, 0.8221, 0.8351, 0.8474, 0.8588}},
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

const OfGaussian& tableOf(FineFilters filters, Element element) {
  return (filters == FineFilters::TwoOfPlanes ? kTwoFilters : kOneFilter)[element];
}

// log2 of the widest profile over an element, of which next to nothing lies there.
constexpr double kWidestOfAll = 7;

std::vector<double> extended(const OfBurley& fit) {
  std::vector<double> samples(fit.samples, fit.samples + OfBurley::kFitted);
  for (double x = fit.first + kStep * OfBurley::kFitted; x < kWidestOfAll; x += kStep) {
    const double r = fit.radius * std::exp2(-x);
    samples.push_back(0.25 * std::exp(-r) + 0.75 * std::exp(-r / 3));  // Christensen & Burley 2015, the cdf
  }
  samples.push_back(1);
  return samples;
}

}  // namespace

EnergyFrom gaussianEnergy(FineFilters filters, Element element) {
  const OfGaussian& table = tableOf(filters, element);
  return {table.first, table.samples};
}

EnergyFrom burleyEnergy(FineFilters filters, Element element) {
  static const auto mixtures = [] {
    std::array<Mixture, kElements> all;
    for (int i = 0; i < kElements; ++i) all[i] = mixtureOf(kOneFilter[i]);
    return all;
  }();
  static const auto fits = [] {
    std::array<std::vector<double>, kElements> all;
    for (int i = 0; i < kElements; ++i) all[i] = extended(kTwoFiltersOfBurley[i]);
    return all;
  }();
  if (filters == FineFilters::TwoOfPlanes) return {kTwoFiltersOfBurley[element].first, fits[element]};
  return {kOneFilter[element].first - kWidest, mixtures[element]};
}

}  // namespace pellucid
