// A material's diffusion profile as the pyramid's passes read it.
#include "material/tables.h"

#include <algorithm>
#include <cmath>

#include "material/pyramid_energy.h"
#include "shared/pellucid_filters.h"

namespace pellucid {
namespace {

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

// One Gaussian can ask for a negative weight of an element, which counts as 0. Where a level and coarser ones
// have nothing, the level itself has what others give it.
double shareOf(double coarser, double all) { return all > 1e-9 ? std::clamp(coarser / all, 0.0, 1.0) : 0; }

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
  const double from = least - 3, step = (most + 6 - from) / kEntries;
  c.range = {static_cast<float>(from), static_cast<float>(1 / step), 0, 0};
  for (int channel = 0; channel < 3; ++channel) {
    Energy level2{kLevel2, 0}, level3{kLevel3, 0}, level3Above{kLevel3, 1}, coarser{kCoarser, 0},
        coarserAbove{kCoarser, 1};
    // Of a pixel with that side.
    Energy pixelLevel2{kLevel2, 2}, pixelFine{kFine, 0};
    const double burley = static_cast<double>(m.burleyDistance[channel]);
    for (Energy* e : {&level2, &level3, &level3Above, &coarser, &coarserAbove, &pixelLevel2, &pixelFine}) {
      if (burley > 0) {
        e->add(burleyEnergy(e->element), 1, std::log2(burley) - from, step);
        continue;
      }
      const EnergyFrom gaussian = gaussianEnergy(e->element);
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
      const double second = std::clamp(pixelLevel2.sum[i], 0.0, 1.0);
      const double shares[] = {second, std::max(second, pixelFine.sum[i])};
      for (int k = 0; k < PELLUCID_PIXEL_SHARES; ++k)
        c.pixelShare[PELLUCID_PIXEL_SHARES * i + k][channel] = static_cast<float>(shares[k]);
    }
  }
  return c;
}

}  // namespace pellucid
