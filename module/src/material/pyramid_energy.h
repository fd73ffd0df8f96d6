// How a profile's energy is shared out among the pixel, its fine filters and the pyramid's levels.
#pragma once

#include <cstdint>
#include <span>

namespace pellucid {

// The fine filter, level 2, level 3, and any coarser one.
enum Element { kFine, kLevel2, kLevel3, kCoarser, kElements };

// A Gaussian of at most 2^this texels of a level from 4 on has at most a thousandth of its energy at that
// level and coarser ones.
constexpr double kCoarserBegins = -1.5;

// Standard deviation of what a level of the pyramid stands for, pixels.
double levelDeviation(uint32_t level);
// The widest Gaussian that has nothing in coarser levels than this one, from 3 on; pixels.
double deviationWithin(uint32_t level);

// The energy at an element and coarser ones, over log2 of a profile's width in pixels; for levels, in texels.
// 0 up to the first sample, 1 from the last one on. One Gaussian between two elements may ask for less than 0
// or more than 1.
struct EnergyFrom {
  static constexpr double kStep = 0.125;
  double first;
  std::span<const double> samples;
};

// Of a Gaussian; width: its standard deviation.
EnergyFrom gaussianEnergy(Element element);

// Of the profile of Christensen & Burley 2015, eq. 3; width: d.
EnergyFrom burleyEnergy(Element element);

}  // namespace pellucid
