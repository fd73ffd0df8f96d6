#include "diffusion_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

// Without the fine filter level 2 takes this part of its energy and the pixel the rest.
constexpr double kFineAtLevel2 = 0.3;

// Entries that are not 0; the last one is.
constexpr int kEntries = PELLUCID_SHARE_ENTRIES - 1;

// Energy at an element and coarser ones, of entries whose sides grow by `step` octaves, and what a profile
// adds whose width is 2^x times the first side.
struct Energy {
  Element element;
  int octaves;  // a texel is 2^octaves times the entry's side
  double sum[kEntries] = {};

  void add(const EnergyFrom& from, double weight, double x, double step) {
    const int last = static_cast<int>(from.samples.size()) - 1;
    const double first = (x - octaves - from.first) / EnergyFrom::kStep, down = step / EnergyFrom::kStep;
    int i = 0;
    for (; i < kEntries && first - down * i >= last; ++i) sum[i] += weight;
    for (; i < kEntries; ++i) {
      const double at = first - down * i;
      if (at <= 0) break;  // nor has any wider side
      const int j = static_cast<int>(at);
      const double low = from.samples[j];
      sum[i] += weight * (low + (from.samples[j + 1] - low) * (at - j));
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
  double value;   // R, 1/mm^2
  double curved;  // (r R)'' / r, 1/mm^4
  double fall;    // -d ln R / d ln r^2
  double within;  // part of the energy
};

// Christensen & Burley 2015, eq. 3 and its integral, where the channel has it; the Gaussians that fit it are
// up to a tenth off at some distances.
ProfileAt profileAt(const PellucidMaterial& m, int channel, double squared) {
  if (const double d = static_cast<double>(m.burleyDistance[channel]); d > 0) {
    const double r = std::sqrt(squared), near = std::exp(-r / d), far = std::exp(-r / (3 * d));
    const double scale = 1 / (8 * std::numbers::pi * d * r);
    // Where near and far have become 0 far is the larger.
    const double fall = 0.5 + r / (2 * d) * (far > 0 ? (near + far / 3) / (near + far) : 1.0 / 3);
    return {(near + far) * scale, (near + far / 9) / (d * d) * scale, fall, 1 - 0.25 * near - 0.75 * far};
  }
  ProfileAt sum{};
  for (uint32_t k = 0; k < m.gaussianCount; ++k) {
    const double v = static_cast<double>(m.gaussianVariance[channel][k]), q = squared / (2 * v);
    const double weight = static_cast<double>(m.gaussianWeight[channel][k]), beyond = std::exp(-q);
    const double value = weight * beyond / (2 * std::numbers::pi * v);
    sum.value += value;
    sum.curved += value * (2 * q - 3) / v;
    sum.fall += value * q;
    sum.within += weight * (1 - beyond);
  }
  sum.fall = sum.value > 0 ? sum.fall / sum.value : PELLUCID_MOST_FALL;
  return sum;
}

// A float near `first` whose last bits are the first of another's; `first` >= 0.
uint32_t packPair(double first, double second) {
  const auto bits = [](double v) { return std::bit_cast<uint32_t>(static_cast<float>(v)); };
  const uint32_t last = (bits(second) + 0x8000u) >> 16;
  const uint32_t rest = bits(first) + 0x8000u;
  return ((rest > last ? rest - last : 0) & 0xFFFF0000u) | last;
}

// The profile over distances, up to three octaves of squared ones beyond the radius, from where on it is 0.
void addDistances(const PellucidMaterial& m, shared::KernelConstants& c) {
  const float radius = *std::max_element(m.radius, m.radius + 3);
  // So that the first entry and its reciprocal are finite.
  const double within = std::clamp(static_cast<double>(radius), 1e-12, 1e15);
  const int last = static_cast<int>(std::ceil(2 * std::log2(within))) + 3;
  const auto first = static_cast<float>(std::exp2(last - PELLUCID_DISTANCE_OCTAVES));
  c.reach = {radius, first, 0, 0};
  c.burley.w = 1;
  for (int channel = 0; channel < 3; ++channel) {
    const double d = static_cast<double>(m.burleyDistance[channel]);
    if (d > 0)
      c.burley[channel] = static_cast<float>(std::numbers::log2e / (3 * d));
    else
      c.burley.w = 0;
  }
  constexpr uint32_t kLast = PELLUCID_DISTANCE_ENTRIES - 1;
  for (uint32_t i = 0; i <= kLast; ++i) {
    const auto squared =
        std::bit_cast<float>(std::bit_cast<uint32_t>(first) + (i << PELLUCID_DISTANCE_SHIFT));
    for (int channel = 0; channel < 3; ++channel) {
      const ProfileAt p = profileAt(m, channel, static_cast<double>(squared));
      c.distance[i][channel] = i < kLast ? packPair(p.value, std::clamp(p.curved, -1e30, 1e30)) : 0;
      const double fall = std::clamp(p.fall / PELLUCID_MOST_FALL, 0.0, 1.0);
      c.distance[i].w |= static_cast<uint32_t>(1023 * fall + 0.5) << 10 * channel;
      c.enclosed[i][channel] = static_cast<float>(p.within);
    }
  }
}

}  // namespace

shared::KernelConstants kernelConstants(const PellucidMaterial& m, FineFilters filters, bool distances) {
  shared::KernelConstants c{};
  if (m.gaussianCount == 0) return c;
  const bool two = filters == FineFilters::TwoOfPlanes;
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
    Energy pixelLevel2{kLevel2, 2}, pixelFine{kFine, 0}, pixelNarrow{kNarrow, 0};
    const double burley = static_cast<double>(m.burleyDistance[channel]);
    for (Energy* e :
         {&level2, &level3, &level3Above, &coarser, &coarserAbove, &pixelLevel2, &pixelFine, &pixelNarrow}) {
      if (burley > 0) {
        e->add(burleyEnergy(filters, e->element), 1, std::log2(burley) - from, step);
        continue;
      }
      const EnergyFrom gaussian = gaussianEnergy(filters, e->element);
      for (uint32_t k = 0; k < m.gaussianCount; ++k)
        e->add(gaussian, static_cast<double>(m.gaussianWeight[channel][k]), deviation[channel][k] - from,
               step);
    }
    for (int i = 0; i < kEntries; ++i) {
      const auto put = [&](int table, double share) {
        c.share[table * PELLUCID_SHARE_ENTRIES + i][channel] = static_cast<float>(share);
      };
      put(0, shareOf(level3Above.sum[i], level2.sum[i]));
      put(1, shareOf(coarserAbove.sum[i], level3.sum[i]));
      put(PELLUCID_SHARE_COARSER, shareOf(coarserAbove.sum[i], coarser.sum[i]));
      double second = std::clamp(pixelLevel2.sum[i], 0.0, 1.0), neighbors = pixelFine.sum[i];
      if (filters == FineFilters::None)
        second = neighbors = std::clamp(std::lerp(second, neighbors, kFineAtLevel2), 0.0, 1.0);
      // Of two filters one may have less than nothing, which makes up for the width of the other.
      if (!two) neighbors = std::max(second, neighbors);
      const double shares[] = {second, neighbors, pixelNarrow.sum[i]};
      for (int k = 0; k < PELLUCID_PIXEL_SHARES; ++k)
        c.pixelShare[PELLUCID_PIXEL_SHARES * i + k][channel] = static_cast<float>(shares[k]);
    }
  }
  if (distances) addDistances(m, c);
  return c;
}

}  // namespace pellucid
