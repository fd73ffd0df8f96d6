// From values per wavelength to linear Rec. 709.
#pragma once

#include <span>
#include <vector>

#include "pellucid/pellucid_material.h"
#include "source.h"

namespace pellucid::material {

// The wavelengths spectra are sampled at: 380, 390 ... 780 nm.
inline constexpr int kWavelengthCount = 41;
constexpr double wavelengthAt(int index) { return 380 + 10 * index; }

// Weights that take a value per wavelength, under the illuminant and the CIE 1931 2-degree observer, to
// linear Rec. 709. Each channel sums to 1, so the illuminant itself is (1, 1, 1). Some are negative.
std::vector<Rgb> rec709Weights(PellucidIlluminant illuminant);

// Linear between the samples, constant beyond the ends.
double interpolate(std::span<const double> wavelength, std::span<const double> value, double at);

}  // namespace pellucid::material
