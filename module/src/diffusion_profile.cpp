#include "diffusion_profile.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

// The energy that a Gaussian has at an element of the pyramid and the coarser ones: the four neighbors, level
// 2, level 3, and level l > 3. Sampled over log2 of its standard deviation in pixels; for levels, in texels.
// docs/diffusion.md says how they were fitted.
enum Element { kBinomial, kLevel2, kLevel3, kCoarser, kElements };
constexpr int kSamples = 49;
constexpr double kStep = 0.125;
constexpr double kFirst[kElements] = {-3, -4, -4, -4};
constexpr double kEnergyFrom[kElements][kSamples] = {
    {0,      0,      0.001028, 0.00273, 0.006925, 0.01613, 0.03398, 0.06493, 0.1137, 0.1641,
     0.2248, 0.2941, 0.3699,   0.45,    0.5318,   0.6134,  0.693,   0.7692,  0.8411, 0.9078,
     0.9689, 1.024,  1.072,    1.112,   1.145,    1.168,   1.183,   1.189,   1.186,  1.176,
     1.158,  1.135,  1.109,    1.08,    1.052,    1.026,   1.004,   0.9862,  0.9738, 0.9669,
     0.9652, 0.9682, 0.9751,   0.9843,  0.9933,   1,       1,       1,       1},
    {0,        -0.007494, -0.00955, -0.01154, -0.01322, -0.01432, -0.01453, -0.01341, -0.01033, -0.004472,
     0.005137, 0.0195,    0.03952,  0.06595,  0.09933,  0.14,     0.1882,   0.2437,   0.3062,   0.375,
     0.4492,   0.5274,    0.6078,   0.6885,   0.7671,   0.841,    0.9076,   0.9647,   1.011,    1.045,
     1.067,    1.078,     1.078,    1.071,    1.057,    1.039,    1.021,    1.006,    0.995,    0.9892,
     0.9876,   0.9893,    0.9928,   0.9965,   1,        1,        1,        1,        1},
    {0,        0.001521, -0.001308, -0.005499, -0.01128, -0.01878, -0.02804, -0.03897, -0.05134, -0.06474,
     -0.07861, -0.09218, -0.1044,   -0.1141,   -0.1195,  -0.1189,  -0.1099,  -0.08997, -0.05652, -0.007566,
     0.05778,  0.139,    0.2343,    0.341,     0.4556,   0.5739,   0.6909,   0.8006,   0.8968,   0.9742,
     1.03,     1.065,    1.08,      1.08,      1.069,    1.05,     1.03,     1.01,     1,        1,
     1,        1,        1,         1,         1,        1,        1,        1,        1},
    {0,        0,        0,       0,        0,        0,        0.001855, 0.003915, 0.007045, 0.01103,
     0.01483,  0.0163,   0.01272, 0.002323, -0.01462, -0.03594, -0.05847, -0.07847, -0.09112, -0.09004,
     -0.06834, -0.03484, 0.02392, 0.1099,   0.22,     0.3504,   0.496,    0.6471,   0.7871,   0.9016,
     0.9869,   1.045,    1.08,    1.092,    1.082,    1.057,    1.028,    1.009,    1,        1,
     1,        1,        1,       1,        1,        1,        1,        1,        1},
};
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

shared::KernelConstants kernelConstants(const PellucidMaterial& m) {
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
      const double level2 = std::clamp(energy(kLevel2, 2), 0.0, 1.0);
      c.pixelShare[2 * i][channel] = static_cast<float>(level2);
      // The binomial may take more than there is: at 4/3 of it nothing is left at the pixel itself.
      const double binomial = (energy(kBinomial, 0) - level2) / std::max(1 - level2, 1e-3);
      c.pixelShare[2 * i + 1][channel] = static_cast<float>(std::clamp(binomial, 0.0, 4.0 / 3));
    }
  }
  return c;
}

}  // namespace pellucid
