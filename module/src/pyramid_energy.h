// How a profile's energy is shared out among the pixel, its fine filters and the pyramid's levels.
#pragma once

#include <span>

namespace pellucid {

// Octaves by which levels 4 and coarser take narrower Gaussians than levels from reductions alone, to which
// the table of one filter was fitted: they begin with averages of level 1, which are narrower.
constexpr double kCoarserShift = 0.03;

// Who filters a pixel's neighbors: nobody; one fine filter; two on planes, of pyramids that are filtered on,
// while edges are summed by their distances. docs/diffusion.md has the fits.
enum class FineFilters { None, One, TwoOfPlanes };

// The narrow and the wide fine filter, or the only one, level 2, level 3, and any coarser one.
enum Element { kNarrow, kFine, kLevel2, kLevel3, kCoarser, kElements };

// The energy at an element and coarser ones, over log2 of a profile's width in pixels; for levels, in texels.
// 0 up to the first sample, 1 from the last one on. Between two filters it may be less than 0 or more than 1.
struct EnergyFrom {
  static constexpr double kStep = 0.125;
  double first;
  std::span<const double> samples;
};

// Of a Gaussian; width: its standard deviation.
EnergyFrom gaussianEnergy(FineFilters filters, Element element);

// Of the profile of Christensen & Burley 2015, eq. 3; width: d.
EnergyFrom burleyEnergy(FineFilters filters, Element element);

}  // namespace pellucid
