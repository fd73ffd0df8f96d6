#include "fit/energy_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fit/energy_fit.h"
#include "fit/pyramid_model.h"
#include "pyramid_energy.h"
#include "pyramid_energy_table.h"

namespace pellucid::fit {
namespace {

static_assert(kTables == pellucid::kElements);

// Measured on the checker of pellucid_diffusion_error at 2, 8, 32, 128 pixels: .001 gives .0052 .0050 .0076 .0079,
// .01 .0046 .0050 .0075 .0076, .05 .0046 .0057 .0081 .0082. Without it narrow Gaussians have negative weights
// of level 2, which the module cannot use.
constexpr double kPenalty = 0.015;

constexpr int kPerOctave = static_cast<int>(1 / EnergyFrom::kStep);
// log2 of the deviations that are fitted, pixels.
constexpr int kNarrowest = -3, kWidest = 6;
constexpr int kFits = (kWidest - kNarrowest) * kPerOctave + 1;

// Element of each table, and the log2 of the deviation that it begins at, in pixels or the level's texels.
// Levels coarser than 4 differ from it by less than 1 % of their variance.
struct Source {
  int element, first;
};
constexpr std::array<Source, kTables> kSources = {{{kFineFilter, -3}, {2, -4}, {3, -4}, {4, -4}}};

int octavesOfTexel(int element) { return element < kFirstLevelElement ? 0 : element; }

std::vector<double> deviationsOfFits() {
  std::vector<double> deviations;
  for (int i = 0; i < kFits; ++i) deviations.push_back(std::exp2(kNarrowest + i * EnergyFrom::kStep));
  return deviations;
}

// As the module interpolates it; `octave`: log2 of the deviation in pixels.
double energyAt(const EnergySamples& from, double octave) {
  const double at = (octave - from.first) / EnergyFrom::kStep;
  if (at <= 0) return 0;
  if (at >= kTableSamples - 1) return 1;
  const auto i = static_cast<size_t>(at);
  return std::lerp(from.samples[i], from.samples[i + 1], at - std::floor(at));
}

Eigen::VectorXd weightsOf(const EnergyTable& table, double octave) {
  Eigen::VectorXd weights(kElementCount);
  double before = 1;
  for (int e = kFineFilter; e < kElementCount; ++e) {
    const double from =
        energyAt(table[static_cast<size_t>(std::min(e, kTables) - 1)], octave - octavesOfTexel(e));
    weights[e - 1] = before - from;
    before = from;
  }
  weights[kLastElement] = before;
  return weights;
}

}  // namespace

EnergyTable fitEnergyTable() {
  const EdgeError error(deviationsOfFits());
  std::array<std::array<double, kElementCount>, kFits> energies;
  for (int g = 0; g < kFits; ++g) {
    const Eigen::VectorXd weights = error.best(g, kPenalty);
    double sum = 1;
    for (int e = 0; e < kElementCount; ++e) {
      energies[static_cast<size_t>(g)][static_cast<size_t>(e)] = sum;
      sum -= weights[e];
    }
  }
  EnergyTable table;
  for (size_t i = 0; i < kTables; ++i) {
    const auto [element, first] = kSources[i];
    table[i].first = first;
    const int start = (first + octavesOfTexel(element) - kNarrowest) * kPerOctave;
    for (int k = 0; k < kTableSamples; ++k) {
      const double energy = energies[static_cast<size_t>(start + k)][static_cast<size_t>(element)];
      table[i].samples[static_cast<size_t>(k)] = std::round(energy * 1e4) / 1e4 + 0.0;  // no minus zero
    }
    // Narrower Gaussians have nothing there, wider ones all.
    table[i].samples.front() = 0;
    table[i].samples.back() = 1;
  }
  return table;
}

EnergyTable builtEnergyTable() {
  EnergyTable table;
  for (size_t i = 0; i < kTables; ++i) {
    const EnergyFrom from = gaussianEnergy(static_cast<Element>(i));
    table[i].first = from.first;
    std::copy_n(from.samples.begin(), kTableSamples, table[i].samples.begin());
  }
  return table;
}

double largestDifference(const EnergyTable& a, const EnergyTable& b) {
  double most = 0;
  for (size_t i = 0; i < kTables; ++i) {
    most = std::max(most, std::abs(a[i].first - b[i].first));
    for (size_t k = 0; k < kTableSamples; ++k)
      most = std::max(most, std::abs(a[i].samples[k] - b[i].samples[k]));
  }
  return most;
}

std::string textOf(const EnergyTable& table) {
  std::string text =
      "// Cumulative weights of the pyramid's elements over the deviation of a Gaussian, fitted and written "
      "by `./run fit`;\n"
      "// docs/how-it-works.md, \"Fitted tables\". Each row: log2 of the first deviation, and samples "
      "EnergyFrom::kStep apart.\n"
      "#pragma once\n\n"
      "namespace pellucid {\n\n"
      "struct GaussianEnergy {\n"
      "  double first;\n"
      "  double samples[" +
      std::to_string(kTableSamples) +
      "];\n};\n\n"
      "// clang-format off\n"
      "constexpr GaussianEnergy kGaussianEnergy[] = {";
  for (const EnergySamples& row : table) {
    char number[32];
    std::snprintf(number, sizeof number, "\n  {%g, {", row.first);
    text += number;
    for (size_t k = 0; k < row.samples.size(); ++k) {
      std::snprintf(number, sizeof number, "%s%.4f",
                    k == 0        ? ""
                    : k % 10 == 0 ? ",\n    "
                                  : ", ",
                    row.samples[k]);
      text += number;
    }
    text += "}},";
  }
  return text + "\n};\n// clang-format on\n\n}  // namespace pellucid\n";
}

std::vector<GaussianErrors> errorsOf(const EnergyTable& table) {
  constexpr int kEach = kPerOctave / 2;
  const EdgeError error(deviationsOfFits());
  std::vector<GaussianErrors> errors;
  for (int g = 0; g < kFits; g += kEach) {
    const double octave = kNarrowest + g * EnergyFrom::kStep;
    const double untouched = error.of(g, Eigen::VectorXd::Unit(kElementCount, kPixel));
    errors.push_back({std::exp2(octave), std::sqrt(error.of(g, weightsOf(table, octave)) / untouched),
                      std::sqrt(error.of(g, error.best(g, 0)) / untouched)});
  }
  return errors;
}

}  // namespace pellucid::fit
