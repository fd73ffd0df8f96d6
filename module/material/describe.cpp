#include "describe.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "presets.h"
#include "skin.h"
#include "spectrum.h"

namespace pellucid::material {
namespace {

constexpr double kDefaultIor = 1.4;

// The range in 1/mm beyond which lengths stop being representable in the float results.
constexpr double kLeastExtinction = 1e-6, kMostExtinction = 1e6;

void requireNotNegative(const std::string& field, double value) {
  if (!(value >= 0 && std::isfinite(value)))
    throw Refusal(field, number(value) + " is not a finite number of at least 0");
}

void checkMedium(const PellucidMaterialDesc& desc) {
  if (!(desc.g > -1 && desc.g < 1)) throw Refusal("g", number(desc.g) + " is not between -1 and 1");
  if (!(desc.millimetersPerUnit >= 0 && std::isfinite(desc.millimetersPerUnit)))
    throw Refusal("millimetersPerUnit", number(desc.millimetersPerUnit) + " is not a positive length");
}

double checkedIor(double ior, double fallback) {
  if (ior == 0) return fallback;
  requireRange("ior", ior, 1, 3);
  return ior;
}

PellucidIlluminant checkedIlluminant(uint32_t illuminant) {
  if (illuminant > PELLUCID_ILLUMINANT_E)
    throw Refusal("illuminant", std::to_string(illuminant) + " is no PellucidIlluminant");
  return static_cast<PellucidIlluminant>(illuminant);
}

Description describeCoefficients(const PellucidMaterialDesc& desc) {
  checkMedium(desc);
  std::vector<Stack> channels;
  for (std::size_t c = 0; c < 3; ++c)
    channels.push_back({{},
                        checkedCoefficients(desc, indexed("scattering", c), indexed("absorption", c),
                                            desc.scattering[c], desc.absorption[c])});
  return rgbDescription(checkedIor(desc.ior, kDefaultIor), std::move(channels));
}

const Preset& checkedPreset(const PellucidMaterialDesc& desc) {
  if (desc.preset == nullptr) throw Refusal("preset", "no name is given");
  const Preset* preset = findPreset(desc.preset);
  if (preset == nullptr) {
    std::string names;
    for (const Preset& known : presets()) {
      if (!names.empty()) names += ", ";
      names += known.name;
    }
    throw Refusal("preset", std::string(desc.preset) + " is not one of " + names);
  }
  return *preset;
}

Description describePreset(const PellucidMaterialDesc& desc) {
  const Preset& preset = checkedPreset(desc);
  const double ior = checkedIor(desc.ior, preset.ior);
  if (preset.layered) return threeLayerSkin(ior);
  std::vector<Stack> channels;
  for (std::size_t c = 0; c < 3; ++c) channels.push_back({{}, {preset.scattering[c], preset.absorption[c]}});
  return rgbDescription(ior, std::move(channels));
}

Description describeSpectrum(const PellucidMaterialDesc& desc) {
  checkMedium(desc);
  requireCount("wavelengthCount", desc.wavelengthCount, 2, PELLUCID_MAX_WAVELENGTHS);
  if (desc.wavelength == nullptr) throw Refusal("wavelength", "no array is given");
  if (desc.spectralScattering == nullptr) throw Refusal("spectralScattering", "no array is given");
  if (desc.spectralAbsorption == nullptr) throw Refusal("spectralAbsorption", "no array is given");
  const std::span wavelength(desc.wavelength, desc.wavelengthCount);
  const std::span scattering(desc.spectralScattering, desc.wavelengthCount);
  const std::span absorption(desc.spectralAbsorption, desc.wavelengthCount);
  for (std::size_t i = 0; i < wavelength.size(); ++i) {
    requireRange(indexed("wavelength", i), wavelength[i], 1, 1e6);
    if (i > 0 && !(wavelength[i] > wavelength[i - 1]))
      throw Refusal(indexed("wavelength", i), number(wavelength[i]) + " does not increase");
    checkedCoefficients(desc, indexed("spectralScattering", i), indexed("spectralAbsorption", i),
                        scattering[i], absorption[i]);
  }
  if (wavelength.front() > wavelengthAt(kWavelengthCount - 1) || wavelength.back() < wavelengthAt(0))
    throw Refusal("wavelength", number(wavelength.front()) + " to " + number(wavelength.back()) +
                                    " nm has no part in 380 to 780");
  Description description{
      checkedIor(desc.ior, kDefaultIor), {}, rec709Weights(checkedIlluminant(desc.illuminant))};
  for (int i = 0; i < kWavelengthCount; ++i) {
    const double nm = wavelengthAt(i);
    description.stacks.push_back({{},
                                  checkedCoefficients(desc, "spectralScattering", "spectralAbsorption",
                                                      interpolate(wavelength, scattering, nm),
                                                      interpolate(wavelength, absorption, nm))});
  }
  return description;
}

Description describeSkin(const PellucidMaterialDesc& desc) {
  requireRange("melanin", desc.melanin, 0, 1);
  requireRange("melaninType", desc.melaninType, 0, 1);
  requireRange("hemoglobin", desc.hemoglobin, 0, 1);
  return physiologicalSkin({desc.melanin, desc.melaninType, desc.hemoglobin},
                           checkedIlluminant(desc.illuminant), checkedIor(desc.ior, kDefaultIor));
}

}  // namespace

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string indexed(std::string field, std::size_t i) {
  field += '[';
  field += std::to_string(i);
  field += ']';
  return field;
}

void requireRange(const std::string& field, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Refusal(field, number(value) + " is not within " + number(low) + " to " + number(high));
}

void requireCount(const std::string& field, std::size_t value, std::size_t low, std::size_t high) {
  if (value < low || value > high)
    throw Refusal(field, std::to_string(value) + " is not within " + std::to_string(low) + " to " +
                             std::to_string(high));
}

Coefficients checkedCoefficients(const PellucidMaterialDesc& desc, const std::string& scatteringField,
                                 const std::string& absorptionField, double scattering, double absorption) {
  const double unit = desc.millimetersPerUnit == 0 ? 1 : desc.millimetersPerUnit;
  requireNotNegative(scatteringField, scattering);
  requireNotNegative(absorptionField, absorption);
  const Coefficients result{scattering * (1 - desc.g) / unit, absorption / unit};
  if (scattering == 0 && absorption == 0)
    throw Refusal(scatteringField, "0, like " + absorptionField + "; one of them must be positive");
  if (!(result.extinction() >= kLeastExtinction && result.extinction() <= kMostExtinction))
    throw Refusal(scatteringField, "reduced scattering and absorption add up to " +
                                       number(result.extinction()) + " per mm, not within " +
                                       number(kLeastExtinction) + " to " + number(kMostExtinction));
  return result;
}

std::optional<Description> describe(const PellucidMaterialDesc& desc) {
  switch (desc.kind) {
    case PELLUCID_MATERIAL_COEFFICIENTS:
      return describeCoefficients(desc);
    case PELLUCID_MATERIAL_PRESET:
      return describePreset(desc);
    case PELLUCID_MATERIAL_SPECTRAL:
      return describeSpectrum(desc);
    case PELLUCID_MATERIAL_SKIN:
      return describeSkin(desc);
    case PELLUCID_MATERIAL_BURLEY:
    case PELLUCID_MATERIAL_GAUSSIANS:
    case PELLUCID_MATERIAL_THIN_WALL:
      return std::nullopt;
    default:
      throw Refusal("kind", std::to_string(desc.kind) + " is no PellucidMaterialKind");
  }
}

const char* kindName(const PellucidMaterialDesc& desc) {
  switch (desc.kind) {
    case PELLUCID_MATERIAL_PRESET:
      return checkedPreset(desc).name;
    case PELLUCID_MATERIAL_BURLEY:
      return "burley";
    case PELLUCID_MATERIAL_GAUSSIANS:
      return "gaussians";
    case PELLUCID_MATERIAL_SPECTRAL:
      return "spectral";
    case PELLUCID_MATERIAL_SKIN:
      return "skin";
    case PELLUCID_MATERIAL_THIN_WALL:
      return "thin_wall";
    default:
      return "coefficients";
  }
}

}  // namespace pellucid::material
