#include "diffusion_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/packing.hpp>
#include <numbers>

namespace pellucid {
namespace {

// The energy that a Gaussian has at an element of the pyramid and the coarser ones: the fine filter, level
// 2, level 3, and level l > 3. Sampled over log2 of its standard deviation in pixels; for levels, in texels.
// docs/diffusion.md says how they were fitted.
enum Element { kFine, kLevel2, kLevel3, kCoarser, kElements };
constexpr int kSamples = 49;
constexpr double kStep = 0.125;
constexpr double kFirst[kElements] = {-3, -4, -4, -4 - kCoarserShift};
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

// Entries that are not 0; the last one is.
constexpr int kEntries = PELLUCID_SHARE_ENTRIES - 1;

// Energy at an element and coarser ones, of entries whose sides grow by `step` octaves, and what one Gaussian
// adds: x is log2 of its deviation over the first side.
struct Energy {
  Element element;
  int octaves;  // a texel is 2^octaves times the entry's side
  double sum[kEntries] = {};

  void add(double weight, double x, double step) {
    const double first = (x - octaves - kFirst[element]) / kStep, down = step / kStep;
    int i = 0;
    for (; i < kEntries && first - down * i >= kSamples - 1; ++i) sum[i] += weight;
    for (; i < kEntries; ++i) {
      const double at = first - down * i;
      if (at <= 0) break;  // nor has any wider side
      const int j = static_cast<int>(at);
      const double low = kEnergyFrom[element][j];
      sum[i] += weight * (low + (kEnergyFrom[element][j + 1] - low) * (at - j));
    }
  }
};

// Few Gaussians can ask for a negative weight of an element; it counts as 0.
double shareOf(double coarser, double all) {
  coarser = std::max(coarser, 0.0);
  all = std::max(coarser, all);
  return all > 1e-9 ? coarser / all : 0;
}

// At a squared distance in mm^2.
struct ProfileAt {
  double value;   // r^2 R
  double within;  // part of the energy
};

// Christensen & Burley 2015, eq. 3 and its integral, where the channel has it; the Gaussians that fit it are
// up to a tenth off at some distances.
ProfileAt profileAt(const PellucidMaterial& m, int channel, double squared) {
  if (const double d = static_cast<double>(m.burleyDistance[channel]); d > 0) {
    const double r = std::sqrt(squared), near = std::exp(-r / d), far = std::exp(-r / (3 * d));
    return {(near + far) * r / (8 * std::numbers::pi * d), 1 - 0.25 * near - 0.75 * far};
  }
  ProfileAt sum{};
  for (uint32_t k = 0; k < m.gaussianCount; ++k) {
    const double q = squared / static_cast<double>(m.gaussianVariance[channel][k]) / 2;
    const double weight = static_cast<double>(m.gaussianWeight[channel][k]), beyond = std::exp(-q);
    sum.value += weight * q * beyond / std::numbers::pi;
    sum.within += weight * (1 - beyond);
  }
  return sum;
}

// The profile over distances, from where the narrowest Gaussian is flat to where the widest has nothing left.
void addDistances(const PellucidMaterial& m, double least, double most, shared::KernelConstants& c) {
  constexpr int kLast = PELLUCID_DISTANCE_ENTRIES - 1;
  const double from = least - 8, step = (most + 6 - from) / kLast;  // log2 of squared mm
  c.reach = {*std::max_element(m.radius, m.radius + 3), static_cast<float>(std::exp2(from)),
             static_cast<float>(from), static_cast<float>(1 / step)};
  for (int i = 0; i <= kLast; ++i) {
    glm::vec3 value(0);
    for (int channel = 0; channel < 3; ++channel) {
      const ProfileAt p = profileAt(m, channel, std::exp2(from + step * i));
      value[channel] = static_cast<float>(p.value);
      c.enclosed[i][channel] = static_cast<float>(p.within);
    }
    c.distance[i] = {glm::packHalf2x16({value.x, value.y}), glm::packHalf2x16({value.z, 0})};
  }
}

}  // namespace

shared::KernelConstants kernelConstants(const PellucidMaterial& m, bool fine, bool distances) {
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
  const double from = least - 3, step = (most + 6 - from) / kEntries;
  c.range = {static_cast<float>(from), static_cast<float>(1 / step), 0, 0};
  for (int channel = 0; channel < 3; ++channel) {
    Energy level2{kLevel2, 0}, level3{kLevel3, 0}, level3Above{kLevel3, 1}, coarser{kCoarser, 0},
        coarserAbove{kCoarser, 1};
    // Of a pixel with that side.
    Energy pixelLevel2{kLevel2, 2}, pixelFine{kFine, 0};
    for (uint32_t k = 0; k < m.gaussianCount; ++k)
      for (Energy* e : {&level2, &level3, &level3Above, &coarser, &coarserAbove, &pixelLevel2, &pixelFine})
        e->add(static_cast<double>(m.gaussianWeight[channel][k]), deviation[channel][k] - from, step);
    for (int i = 0; i < kEntries; ++i) {
      const auto put = [&](int table, double share) {
        c.share[table * PELLUCID_SHARE_ENTRIES + i][channel] = static_cast<float>(share);
      };
      put(0, shareOf(level3Above.sum[i], level2.sum[i]));
      put(1, shareOf(coarserAbove.sum[i], level3.sum[i]));
      put(PELLUCID_SHARE_COARSER, shareOf(coarserAbove.sum[i], coarser.sum[i]));
      double second = std::clamp(pixelLevel2.sum[i], 0.0, 1.0), neighbors = pixelFine.sum[i];
      if (!fine) second = neighbors = std::clamp(std::lerp(second, neighbors, kFineAtLevel2), 0.0, 1.0);
      c.pixelShare[2 * i][channel] = static_cast<float>(second);
      c.pixelShare[2 * i + 1][channel] = static_cast<float>(std::max(second, neighbors));
    }
  }
  if (distances) addDistances(m, 2 * least, 2 * most, c);
  return c;
}

}  // namespace pellucid
