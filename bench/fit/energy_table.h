// module/src/pyramid_energy_table.h: cumulative weights of the pyramid's elements over the Gaussian's
// deviation.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace pellucid::fit {

// As pellucid::Element numbers them.
constexpr int kTables = 4;
constexpr int kTableSamples = 49;

// Energy at an element and coarser ones. `first`: log2 of the first sample's deviation, in pixels; of levels,
// in texels.
struct EnergySamples {
  double first;
  std::array<double, kTableSamples> samples;
};

using EnergyTable = std::array<EnergySamples, kTables>;

// Minimizes EdgeError for each Gaussian. Values of four decimals, as the file has.
EnergyTable fitEnergyTable();

// That the module was built with.
EnergyTable builtEnergyTable();

// The largest difference of two samples.
double largestDifference(const EnergyTable& a, const EnergyTable& b);

// The file.
std::string textOf(const EnergyTable& table);

// Errors of a Gaussian, relative to the error of leaving the image as it is.
struct GaussianErrors {
  double deviation;      // pixels
  double table;          // of the table's weights; level 4's samples stand for all coarser levels
  double unconstrained;  // the least that any weights have
};

// Errors from Gaussians half an octave apart.
std::vector<GaussianErrors> errorsOf(const EnergyTable& table);

}  // namespace pellucid::fit
