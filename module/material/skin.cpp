#include "skin.h"

#include <cmath>
#include <numbers>

#include "spectrum.h"

namespace pellucid::material {
namespace {

// Molar extinction of hemoglobin, 1/(cm M), decadic, every 10 nm from 380; compiled by S. Prahl from
// Gratzer and Kollias (omlc.org/spectra/hemoglobin/summary.html).
struct Hemoglobin {
  double oxygenated, deoxygenated;
};
constexpr Hemoglobin kHemoglobin[kWavelengthCount] = {
    {109564, 145232},   {167748, 167780},   {266232, 223296}, {466840, 303956},   {480360, 407560},
    {246072, 528600},   {102580, 413280},   {62816, 103292},  {44480, 23388.8},   {33209.2, 16156.4},
    {26629.2, 14550},   {23684.4, 16684},   {20932.8, 20862}, {20035.2, 25773.6}, {24202.4, 31589.6},
    {39956.8, 39036.4}, {53236, 46592},     {43016, 53412},   {32613.2, 53788},   {44496, 45072},
    {50104, 37020},     {14400.8, 28324.4}, {3200, 14677.2},  {1506, 9443.6},     {942, 6509.6},
    {610, 5148.8},      {442, 4345.2},      {368, 3750.12},   {319.6, 3226.56},   {294, 2795.12},
    {277.6, 2407.92},   {276, 2051.96},     {290, 1794.28},   {314, 1540.48},     {348, 1325.88},
    {390, 1102.2},      {446, 1115.88},     {518, 1405.24},   {586, 1548.52},     {650, 1311.88},
    {710, 1075.44},
};

// Absorption of whole blood, 1/mm: 150 g/l of hemoglobin of 64500 g/mol, three quarters of it oxygenated.
double bloodAbsorption(int wavelength) {
  constexpr double kOxygenated = 0.75, kMolar = 150.0 / 64500, kPerMillimeter = 0.1;
  const Hemoglobin& e = kHemoglobin[wavelength];
  return std::numbers::ln10 * kMolar * kPerMillimeter *
         (kOxygenated * e.oxygenated + (1 - kOxygenated) * e.deoxygenated);
}

}  // namespace

Description threeLayerSkin(double ior) {
  constexpr double kPerMillimeter = 0.1;  // the published table is in 1/cm
  struct Layer {
    double absorption[3], scattering[3], thickness;  // 1/cm, mm
  };
  constexpr Layer kEpidermis = {{2.1, 2.1, 5.0}, {48, 60, 65}, 0.25};
  constexpr Layer kUpperDermis = {{0.16, 0.19, 0.30}, {32, 40, 46}, 0.20};
  constexpr Layer kBloodyDermis = {{0.085, 1.0, 25}, {4.5, 4.7, 4.8}, 0};
  const auto coefficients = [](const Layer& layer, int c) {
    return Coefficients{layer.scattering[c] * kPerMillimeter, layer.absorption[c] * kPerMillimeter};
  };
  std::vector<Stack> channels;
  for (int c = 0; c < 3; ++c)
    channels.push_back({{{coefficients(kEpidermis, c), kEpidermis.thickness},
                         {coefficients(kUpperDermis, c), kUpperDermis.thickness}},
                        coefficients(kBloodyDermis, c)});
  return rgbDescription(ior, std::move(channels));
}

Description physiologicalSkin(const Physiology& physiology, PellucidIlluminant illuminant, double ior) {
  constexpr double kEpidermis = 0.25;  // mm
  const auto& [melanin, type, hemoglobin] = physiology;
  Description skin{ior, {}, rec709Weights(illuminant)};
  for (int i = 0; i < kWavelengthCount; ++i) {
    // All in 1/mm with the wavelength in nm. Eumelanin and the baseline, tissue without melanin and
    // blood, are those of Jacques 1998, "Skin optics".
    const double nm = wavelengthAt(i);
    const double eumelanin = 6.6e10 * std::pow(nm, -3.33), pheomelanin = 2.9e14 * std::pow(nm, -4.75);
    const double baseline = 0.0244 + 8.53 * std::exp(-(nm - 154) / 66.2);
    const double scattering = 14.74 * std::pow(nm, -0.22) + 2.2e11 * std::pow(nm, -4);
    const Coefficients epidermis{
        scattering, melanin * (type * eumelanin + (1 - type) * pheomelanin) + (1 - melanin) * baseline};
    const Coefficients dermis{scattering / 2, hemoglobin * bloodAbsorption(i) + (1 - hemoglobin) * baseline};
    skin.stacks.push_back({{{epidermis, kEpidermis}}, dermis});
  }
  return skin;
}

}  // namespace pellucid::material
