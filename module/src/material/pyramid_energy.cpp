#include "material/pyramid_energy.h"

#include <array>
#include <cmath>
#include <iterator>

#include "material/pyramid_energy_table.h"
#include "shared/pellucid_filters.h"

namespace pellucid {
namespace {

constexpr double kStep = EnergyFrom::kStep;
constexpr int kSamples = std::size(kGaussianEnergy[0].samples);
static_assert(std::size(kGaussianEnergy) == kElements);

// log2 of the narrowest and the widest Gaussian of Burley's profile at d = 1.
constexpr int kNarrowest = -11, kWidest = 4;
constexpr int kBurleySamples = kSamples + static_cast<int>((kWidest - kNarrowest) / kStep);

using Mixture = std::array<double, kBurleySamples>;

// e^{-r/a} / (2 pi a r) is a mixture of Gaussians whose deviations s have the density
// sqrt(2 / pi) / a e^{-s^2 / (2 a^2)}, as e^{-r/a} / r = 2 / sqrt(pi) int_0^inf e^{-r^2 t^2 - 1 / (4 a^2
// t^2)} dt with t^2 = 1 / (2 s^2). Burley's is a quarter of that with a = d and three of a = 3 d.
Mixture mixtureOf(const GaussianEnergy& gaussian) {
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

double levelDeviation(uint32_t level) {
  return std::sqrt(PELLUCID_LEVEL_VARIANCE_SCALE * std::exp2(2.0 * level) + PELLUCID_LEVEL_VARIANCE_REST);
}

double deviationWithin(uint32_t level) { return std::exp2(level + 1 + kCoarserBegins); }

EnergyFrom gaussianEnergy(Element element) {
  return {kGaussianEnergy[element].first, kGaussianEnergy[element].samples};
}

EnergyFrom burleyEnergy(Element element) {
  static const auto mixtures = [] {
    std::array<Mixture, kElements> all;
    for (int i = 0; i < kElements; ++i) all[i] = mixtureOf(kGaussianEnergy[i]);
    return all;
  }();
  return {kGaussianEnergy[element].first - kWidest, mixtures[element]};
}

}  // namespace pellucid
