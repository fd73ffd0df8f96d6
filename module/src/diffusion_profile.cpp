#include "diffusion_profile.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

// The energy that a Gaussian has at an element of the pyramid and the coarser ones: the fine filter, level
// 2, level 3, and level l > 3. Sampled over log2 of its standard deviation in pixels; for levels, in texels.
// docs/diffusion.md says how they were fitted.
enum Element { kFine, kLevel2, kLevel3, kCoarser, kElements };
constexpr int kSamples = 49;
constexpr double kStep = 0.125;
constexpr double kFirst[kElements] = {-3, -4, -4, -4};
constexpr double kEnergyFrom[kElements][kSamples] = {
    {0,      0,      0.0006638, 0.003575, 0.009764, 0.02009, 0.03606, 0.05961, 0.09098, 0.1304,
     0.175,  0.2248, 0.2839,    0.3504,   0.4224,   0.4982,  0.5799,  0.6655,  0.7515,  0.8292,
     0.8968, 0.9569, 1.012,     1.06,     1.104,    1.14,    1.166,   1.177,   1.177,   1.167,
     1.154,  1.136,  1.118,     1.097,    1.075,    1.052,   1.033,   1.018,   1.01,    1.006,
     1.005,  1.004,  1.003,     1.002,    1.001,    1.001,   1,       1,       1},
    {0,        -0.001361, -0.003499, 0.01817,  0.005962,  0.008113, 0.001908, 0.009758, 0.001368, -0.008796,
     -0.03024, -0.04052,  -0.02883,  -0.01623, -0.004877, 0.002425, 0.0169,   0.04507,  0.08557,  0.1484,
     0.2295,   0.3219,    0.4223,    0.5227,   0.6177,    0.7089,   0.7965,   0.876,    0.9449,   0.9977,
     1.031,    1.046,     1.049,     1.046,    1.04,      1.032,    1.022,    1.013,    1.007,    1.006,
     1.006,    1.005,     1.004,     1.002,    1.001,     1,        0.9998,   0.9998,   1},
    {0,        -0.008264, -0.001188, -0.01123, 0,        0.0007493, 0.00718,  0.03786,  0.03136,  0.03061,
     0.02214,  0.02143,   0.006304,  -0.02053, -0.05872, -0.08738,  -0.09185, -0.08449, -0.06675, -0.03891,
     0.003059, 0.06459,   0.1444,    0.2538,   0.3818,   0.5117,    0.639,    0.7576,   0.8639,   0.9514,
     1.014,    1.05,      1.065,     1.066,    1.057,    1.043,     1.025,    1.011,    1.004,    1.004,
     1.008,    1.01,      1.01,      1.006,    1.002,    0.9985,    0.9972,   0.9981,   1},
    {0,        -0.006975, 0.006749, -0.01058,  -0.00107,  -0.0005165, -0.002841, 0.008785, 0.002845, 0.01759,
     0.002336, 0.01514,   0.003296, -0.002201, -0.003651, -0.019,     -0.02866,  -0.04148, -0.04129, -0.03652,
     -0.01229, 0.03441,   0.1036,   0.2021,    0.3185,    0.4456,     0.5802,    0.7123,   0.8367,   0.9352,
     1.002,    1.039,     1.054,    1.056,     1.049,     1.035,      1.02,      1.008,    1.004,    1.008,
     1.014,    1.017,     1.017,    1.013,     1.007,     1.002,      0.9992,    0.9988,   1},
};
// Without the fine filter level 2 takes this part of its energy and the pixel the rest.
constexpr double kFineAtLevel2 = 0.3;

double sample(Element element, double x) {
  const double at = std::clamp((x - kFirst[element]) / kStep, 0.0, kSamples - 1.0);
  const int i = std::min(static_cast<int>(at), kSamples - 2);
  return std::lerp(kEnergyFrom[element][i], kEnergyFrom[element][i + 1], at - i);
}

// Few Gaussians can ask for a negative weight of an element; it counts as 0.
double shareOf(double coarser, double all) {
  coarser = std::max(coarser, 0.0);
  all = std::max(coarser, all);
  return all > 1e-9 ? coarser / all : 0;
}

}  // namespace

shared::KernelConstants kernelConstants(const PellucidMaterial& m, bool fine) {
  shared::KernelConstants c{};
  if (m.gaussianCount == 0) return c;
  double deviation[3][PELLUCID_MAX_GAUSSIANS];  // log2, mm
  double least = INFINITY, most = -INFINITY;
  for (int channel = 0; channel < 3; ++channel)
    for (uint32_t k = 0; k < m.gaussianCount; ++k) {
      deviation[channel][k] = std::log2(static_cast<double>(m.gaussianVariance[channel][k])) / 2;
      least = std::min(least, deviation[channel][k]);
      most = std::max(most, deviation[channel][k]);
    }
  // With texels 3 octaves finer than the narrowest Gaussian all is coarser; 6 octaves beyond the widest
  // nothing is.
  constexpr int last = PELLUCID_SHARE_ENTRIES - 1;
  const double from = least - 3, to = most + 6;
  c.range = {static_cast<float>(from), static_cast<float>(last / (to - from)), 0, 0};
  for (int i = 0; i < last; ++i) {  // the last entry stays 0
    const double side = from + (to - from) * i / last;
    for (int channel = 0; channel < 3; ++channel) {
      // Energy at an element and coarser ones with texels of 2^`octaves` times this side.
      const auto energy = [&](Element element, int octaves) {
        double sum = 0;
        for (uint32_t k = 0; k < m.gaussianCount; ++k)
          sum += static_cast<double>(m.gaussianWeight[channel][k]) *
                 sample(element, deviation[channel][k] - side - octaves);
        return sum;
      };
      const auto put = [&](int table, double share) {
        c.share[table * PELLUCID_SHARE_ENTRIES + i][channel] = static_cast<float>(share);
      };
      const double coarser = energy(kCoarser, 1), level3 = energy(kLevel3, 1);
      put(0, shareOf(level3, energy(kLevel2, 0)));
      put(1, shareOf(coarser, energy(kLevel3, 0)));
      put(PELLUCID_SHARE_COARSER, shareOf(coarser, energy(kCoarser, 0)));
      // Here the side is a pixel's.
      double level2 = std::clamp(energy(kLevel2, 2), 0.0, 1.0), neighbors = energy(kFine, 0);
      if (!fine) level2 = neighbors = std::clamp(std::lerp(level2, neighbors, kFineAtLevel2), 0.0, 1.0);
      c.pixelShare[2 * i][channel] = static_cast<float>(level2);
      const double share = (neighbors - level2) / std::max(1 - level2, 1e-3);
      c.pixelShare[2 * i + 1][channel] = static_cast<float>(std::clamp(share, 0.0, 1.2));
    }
  }
  return c;
}

}  // namespace pellucid
