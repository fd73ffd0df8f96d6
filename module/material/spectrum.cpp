#include "spectrum.h"

#include <algorithm>
#include <cmath>

namespace pellucid::material {
namespace {

// CIE 15:2004: color matching functions of the 1931 standard observer (table T.4) and the relative power
// of D65 (table T.1), every 10 nm from 380.
struct Row {
  double x, y, z, d65;
};
constexpr Row kTable[kWavelengthCount] = {
    {0.001368, 0.000039, 0.006450, 49.9755}, {0.004243, 0.000120, 0.020050, 54.6482},
    {0.014310, 0.000396, 0.067850, 82.7549}, {0.043510, 0.001210, 0.207400, 91.4860},
    {0.134380, 0.004000, 0.645600, 93.4318}, {0.283900, 0.011600, 1.385600, 86.6823},
    {0.348280, 0.023000, 1.747060, 104.865}, {0.336200, 0.038000, 1.772110, 117.008},
    {0.290800, 0.060000, 1.669200, 117.812}, {0.195360, 0.090980, 1.287640, 114.861},
    {0.095640, 0.139020, 0.812950, 115.923}, {0.032010, 0.208020, 0.465180, 108.811},
    {0.004900, 0.323000, 0.272000, 109.354}, {0.009300, 0.503000, 0.158200, 107.802},
    {0.063270, 0.710000, 0.078250, 104.790}, {0.165500, 0.862000, 0.042160, 107.689},
    {0.290400, 0.954000, 0.020300, 104.405}, {0.433450, 0.994950, 0.008750, 104.046},
    {0.594500, 0.995000, 0.003900, 100.000}, {0.762100, 0.952000, 0.002100, 96.3342},
    {0.916300, 0.870000, 0.001650, 95.7880}, {1.026300, 0.757000, 0.001100, 88.6856},
    {1.062200, 0.631000, 0.000800, 90.0062}, {1.002600, 0.503000, 0.000340, 89.5991},
    {0.854450, 0.381000, 0.000190, 87.6987}, {0.642400, 0.265000, 0.000050, 83.2886},
    {0.447900, 0.175000, 0.000020, 83.6992}, {0.283500, 0.107000, 0.000000, 80.0268},
    {0.164900, 0.061000, 0.000000, 80.2146}, {0.087400, 0.032000, 0.000000, 82.2778},
    {0.046770, 0.017000, 0.000000, 78.2842}, {0.022700, 0.008210, 0.000000, 69.7213},
    {0.011359, 0.004102, 0.000000, 71.6091}, {0.005790, 0.002091, 0.000000, 74.3490},
    {0.002899, 0.001047, 0.000000, 61.6040}, {0.001440, 0.000520, 0.000000, 69.8856},
    {0.000690, 0.000249, 0.000000, 75.0870}, {0.000332, 0.000120, 0.000000, 63.5927},
    {0.000166, 0.000060, 0.000000, 46.4182}, {0.000083, 0.000030, 0.000000, 66.8054},
    {0.000042, 0.000015, 0.000000, 63.3828},
};

// CIE 15:2004 eq. 3.1, proportional to Planck's law.
double illuminantA(double wavelength) {
  return std::pow(wavelength, -5) / std::expm1(1.435e7 / (2848 * wavelength));
}

}  // namespace

std::vector<Rgb> rec709Weights(PellucidIlluminant illuminant) {
  // XYZ to Rec. 709 primaries (ITU-R BT.709, IEC 61966-2-1); rows R, G, B.
  constexpr double kMatrix[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                    {-0.9692660, 1.8760108, 0.0415560},
                                    {0.0556434, -0.2040259, 1.0572252}};
  std::vector<Rgb> weights(kWavelengthCount);
  Rgb white = {};
  for (int i = 0; i < kWavelengthCount; ++i) {
    const Row& row = kTable[i];
    const double power = illuminant == PELLUCID_ILLUMINANT_D65 ? row.d65
                         : illuminant == PELLUCID_ILLUMINANT_A ? illuminantA(wavelengthAt(i))
                                                               : 1;
    Rgb& weight = weights[static_cast<std::size_t>(i)];
    for (std::size_t c = 0; c < 3; ++c) {
      weight[c] = power * (kMatrix[c][0] * row.x + kMatrix[c][1] * row.y + kMatrix[c][2] * row.z);
      white[c] += weight[c];
    }
  }
  for (Rgb& weight : weights)
    for (std::size_t c = 0; c < 3; ++c) weight[c] /= white[c];
  return weights;
}

double interpolate(std::span<const double> wavelength, std::span<const double> value, double at) {
  const auto above = std::lower_bound(wavelength.begin(), wavelength.end(), at);
  if (above == wavelength.begin()) return value.front();
  if (above == wavelength.end()) return value.back();
  const auto i = static_cast<std::size_t>(above - wavelength.begin());
  const double t = (at - wavelength[i - 1]) / (wavelength[i] - wavelength[i - 1]);
  return value[i - 1] + t * (value[i] - value[i - 1]);
}

}  // namespace pellucid::material
