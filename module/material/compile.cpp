#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "describe.h"
#include "fit.h"
#include "guarded.h"
#include "material/transmittance.h"
#include "pellucid/pellucid.h"
#include "presets.h"
#include "profile.h"

namespace pellucid::material {
namespace {

struct Result {
  PellucidMaterial material = {};
  PellucidMaterialReport report = {};
};

// Gaussians, radius and distance of Burley's profile of distance d.
void setBurley(Result& result, std::size_t channel, double d, std::uint32_t count) {
  PellucidMaterial& material = result.material;
  const UnitGaussians unit = burleyGaussians(static_cast<int>(count));
  material.gaussianCount = count;
  for (std::size_t i = 0; i < count; ++i) {
    material.gaussianVariance[channel][i] = static_cast<float>(unit.variance[i] * d * d);
    material.gaussianWeight[channel][i] = static_cast<float>(unit.weight[i]);
  }
  material.radius[channel] = static_cast<float>(kBurleyRadius999 * d);
  material.burleyDistance[channel] = static_cast<float>(d);
  result.report.channels[channel].edgeError = unit.edgeError;
}

void setCurve(PellucidMaterial& material, std::size_t channel, const Curve& curve) {
  material.transmittanceModel = static_cast<std::uint32_t>(curve.model);
  std::copy(curve.parameters.begin(), curve.parameters.end(), material.transmittance[channel]);
}

// T(d) to fit, per channel: 0.01 to 20 mm as far as T > 1e-4; further at either end where the medium is so
// dense or so thin that this range would show only a part of its curve.
std::array<std::vector<Sample>, 3> sampleTransmittance(const Source& source) {
  constexpr double kLeast = 1e-4, kTiny = 1e-6;
  constexpr int kSamples = 72, kMinimum = 8;
  // Where wavelengths mix, what is left of a channel deep inside is a small difference of large numbers, or
  // a color outside Rec. 709 cut to 0. Errors there are measured against this share of the brightest channel.
  constexpr double kVisible = 0.5;
  double first = 0.01, last = 20;
  for (int c = 0; c < 3; ++c) {
    first = std::min(first, 0.05 / source.extinction(c));
    last = std::max(last, 3 / source.extinction(c));
  }
  const auto greatest = [&](double d) {
    const std::array<Slab, 3> slabs = source.slabs(d);
    return std::max({slabs[0].transmittance, slabs[1].transmittance, slabs[2].transmittance});
  };
  if (greatest(last) < kLeast) {
    double low = first, high = last;
    for (int step = 0; step < 8; ++step) {
      const double middle = std::sqrt(low * high);
      (greatest(middle) > kLeast ? low : high) = middle;
    }
    last = high;
  }

  std::array<std::vector<Sample>, 3> samples;
  std::array<bool, 3> ended = {};
  for (int i = 0; i < kSamples; ++i) {
    const double d = first * std::pow(last / first, i / (kSamples - 1.0));
    const std::array<Slab, 3> slabs = source.slabs(d);
    const double brightest =
        std::max({slabs[0].transmittance, slabs[1].transmittance, slabs[2].transmittance});
    for (std::size_t c = 0; c < 3; ++c) {
      // Up to and with the first sample below the limit: the curve must reach it.
      const double scale =
          std::max({slabs[c].transmittance, source.mixed() ? kVisible * brightest : 0, kTiny});
      if (!ended[c]) samples[c].push_back({d, slabs[c].transmittance, scale});
      ended[c] = ended[c] || (scale < kLeast && i + 1 >= kMinimum);
    }
  }
  return samples;
}

void compileMedium(const Description& description, std::uint32_t count, Result& result) {
  const Source source(description);
  const std::array<std::vector<Sample>, 3> samples = sampleTransmittance(source);
  // Two exponentials are the cheaper form and the one that can be sampled exactly: taken where they are good
  // to a tenth of a percent in every channel or the better form in every channel.
  constexpr double kGood = 1e-3;
  std::array<Fits, 3> fits;
  std::array<bool, 3> better;  // exp2
  bool exp2Good = true, exp2Better = true;
  for (std::size_t c = 0; c < 3; ++c) {
    const int channel = static_cast<int>(c);
    fits[c] = fitTransmittance(samples[c], source.decay(channel), source.extinction(channel));
    better[c] = fits[c].exp2.error <= fits[c].sinhExp.error;
    exp2Good = exp2Good && fits[c].exp2.error <= kGood;
    exp2Better = exp2Better && better[c];
  }
  const bool exp2 = exp2Good || exp2Better;

  const std::array<Slab, 3> halfSpace = source.slabs(std::numeric_limits<double>::infinity());
  const Rgb burley = source.burleyDistance();
  for (std::size_t c = 0; c < 3; ++c) {
    const Fit& fit = exp2 || better[c] ? fits[c].exp2 : fits[c].sinhExp;
    setCurve(result.material, c, !exp2 && better[c] ? asSinhExp(fit.curve) : fit.curve);
    setBurley(result, c, burley[c], count);
    // Shaders divide by it.
    result.material.reflectance[c] = static_cast<float>(std::max(halfSpace[c].reflectance, 1e-4));
    PellucidChannelReport& channel = result.report.channels[c];
    channel.rho = halfSpace[c].reflectance;
    channel.transmittanceError = fit.error;
    channel.minThickness = samples[c].front().thickness;
    channel.maxThickness = samples[c].back().thickness;
    if (description.stacks.size() == 3 && description.stacks[c].outer.empty()) {
      channel.scattering = description.stacks[c].core.scattering;
      channel.absorption = description.stacks[c].core.absorption;
    }
  }
  result.report.ior = description.ior;
}

Curve checkedCurve(const PellucidMaterialDesc& desc, std::size_t c) {
  const double* given = desc.transmittance[c];
  const double d = desc.burleyDistance[c];
  const bool absent = std::all_of(&desc.transmittance[0][0], &desc.transmittance[0][0] + 12,
                                  [](double value) { return value == 0; });
  Curve curve{PELLUCID_TRANSMITTANCE_EXP2, {}};
  for (std::size_t i = 0; i < 4; ++i) curve.parameters[i] = static_cast<float>(given[i]);
  // Christensen & Burley 2015: what the profile leaves beyond depth d, 1 - cdf(d).
  if (absent)
    curve.parameters = {0.25f, static_cast<float>(1 / d), 0.75f, static_cast<float>(1 / (3 * d)), 0};
  if (!isTransmittance(curve))
    throw Refusal(indexed("transmittance", c), number(given[0]) + " e^{-" + number(given[1]) + " d} + " +
                                                   number(given[2]) + " e^{-" + number(given[3]) +
                                                   " d} does not fall from at most 1 to 0");
  return curve;
}

void compileBurley(const PellucidMaterialDesc& desc, Result& result) {
  for (std::size_t c = 0; c < 3; ++c) {
    requireRange(indexed("burleyDistance", c), desc.burleyDistance[c], 1e-6, 1e6);
    setBurley(result, c, desc.burleyDistance[c], desc.gaussianCount);
    setCurve(result.material, c, checkedCurve(desc, c));
    result.material.reflectance[c] = 1;
    result.report.channels[c].rho = 1;
  }
}

void compileGaussians(const PellucidMaterialDesc& desc, Result& result) {
  PellucidMaterial& material = result.material;
  const std::uint32_t count = desc.gaussianCount;
  material.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
  material.gaussianCount = count;
  for (std::size_t i = 0; i < count; ++i)
    requireRange(indexed("gaussianVariance", i), desc.gaussianVariance[i], 1e-12, 1e12);
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      requireRange(indexed(indexed("gaussianWeight", c), i), desc.gaussianWeight[c][i], 0, 1e12);
      sum += desc.gaussianWeight[c][i];
    }
    if (sum == 0) throw Refusal(indexed("gaussianWeight", c), "every weight is 0");
    double weight[PELLUCID_MAX_GAUSSIANS] = {};
    for (std::size_t i = 0; i < count; ++i) {
      weight[i] = desc.gaussianWeight[c][i] / sum;
      material.gaussianVariance[c][i] = static_cast<float>(desc.gaussianVariance[i]);
      material.gaussianWeight[c][i] = static_cast<float>(weight[i]);
    }
    material.radius[c] =
        static_cast<float>(gaussianRadius999({desc.gaussianVariance, count}, {weight, count}));
    material.reflectance[c] = 1;
    result.report.channels[c].rho = 1;
  }
}

void compileThinWall(const PellucidMaterialDesc& desc, Result& result) {
  PellucidMaterial& material = result.material;
  material.thinWalled = 1;
  const bool spreads =
      std::any_of(desc.burleyDistance, desc.burleyDistance + 3, [](double d) { return d != 0; });
  for (std::size_t c = 0; c < 3; ++c) {
    const double reflected = desc.wallReflectance[c], through = desc.wallTransmittance[c];
    requireRange(indexed("wallReflectance", c), reflected, 0, 1);
    requireRange(indexed("wallTransmittance", c), through, 0, 1);
    // Rounding of sums that are meant to be 1.
    if (reflected + through > 1 + 1e-9)
      throw Refusal(indexed("wallTransmittance", c), number(through) + " and wallReflectance " +
                                                         number(reflected) + " together are more than 1");
    // Shaders divide by it.
    const double rho = std::max(reflected, 1e-4);
    material.reflectance[c] = static_cast<float>(rho);
    material.wallTransmittance[c] = static_cast<float>(std::min(through, 1 - rho));
    setCurve(material, c, {PELLUCID_TRANSMITTANCE_EXP2, {material.wallTransmittance[c], 0, 0, 0, 0}});
    result.report.channels[c].rho = reflected;
    if (!spreads) continue;
    requireRange(indexed("burleyDistance", c), desc.burleyDistance[c], 1e-6, 1e6);
    setBurley(result, c, desc.burleyDistance[c], desc.gaussianCount);
  }
}

Result compile(const PellucidMaterialDesc& desc) {
  requireCount("gaussianCount", desc.gaussianCount, 1, PELLUCID_MAX_GAUSSIANS);
  Result result;
  if (const std::optional<Description> medium = describe(desc))
    compileMedium(*medium, desc.gaussianCount, result);
  else if (desc.kind == PELLUCID_MATERIAL_BURLEY)
    compileBurley(desc, result);
  else if (desc.kind == PELLUCID_MATERIAL_THIN_WALL)
    compileThinWall(desc, result);
  else
    compileGaussians(desc, result);
  const auto refuse = [](void* refusal, PellucidSeverity, const char* field, const char* sentence) {
    static_cast<std::optional<Refusal>*>(refusal)->emplace(std::string("material.") + field, sentence);
  };
  std::optional<Refusal> refusal;
  if (pellucidMakeMaterialTables(&result.material, refuse, &refusal) != PELLUCID_OK) throw *refusal;
  const std::string_view name = kindName(desc);
  name.copy(result.report.name, sizeof result.report.name - 1);
  return result;
}

// ---- The C boundary ----------------------------------------------------------------------------

PellucidSlab publicSlab(const Slab& slab) {
  return {slab.transmittance, slab.transmittanceNormal, slab.reflectance};
}

}  // namespace
}  // namespace pellucid::material

using namespace pellucid::material;

void pellucidInitMaterialDesc(PellucidMaterialDesc* desc) {
  *desc = {};
  desc->gaussianCount = 6;
  desc->melanin = 0.005;
  desc->melaninType = 0.5;
  desc->hemoglobin = 0.005;
}

PellucidResult pellucidCompileMaterial(const PellucidMaterialDesc* desc, PellucidMaterial* material,
                                       PellucidMaterialReport* report, PellucidMessageFn message,
                                       void* messageUser) {
  return guarded(message, messageUser, [&] {
    require("desc", desc);
    require("material", material);
    const Result result = compile(*desc);
    *material = result.material;
    if (report != nullptr) *report = result.report;
  });
}

PellucidResult pellucidSlabTransport(double scattering, double absorption, double ior, double thickness,
                                     PellucidSlab* slab, PellucidMessageFn message, void* messageUser) {
  return guarded(message, messageUser, [&] {
    require("slab", slab);
    PellucidMaterialDesc desc;
    pellucidInitMaterialDesc(&desc);
    const Coefficients coefficients =
        checkedCoefficients(desc, "scattering", "absorption", scattering, absorption);
    requireRange("ior", ior, 1, 3);
    requireRange("thickness", thickness, 0, std::numeric_limits<double>::infinity());
    const Angles angles = makeAngles(ior);
    *slab = publicSlab(Medium(angles, coefficients).slab(thickness));
  });
}

PellucidResult pellucidMaterialSlabs(const PellucidMaterialDesc* desc, uint32_t count,
                                     const double* thickness, PellucidSlab* slabs, PellucidMessageFn message,
                                     void* messageUser) {
  return guarded(message, messageUser, [&] {
    require("desc", desc);
    if (count > 0 && thickness == nullptr) throw Refusal("thickness", "NULL");
    if (count > 0 && slabs == nullptr) throw Refusal("slabs", "NULL");
    for (std::size_t i = 0; i < count; ++i)
      requireRange(indexed("thickness", i), thickness[i], 0, std::numeric_limits<double>::infinity());
    if (const std::optional<Description> medium = describe(*desc)) {
      const Source source(*medium);
      for (std::size_t i = 0; i < count; ++i) {
        const std::array<Slab, 3> rgb = source.slabs(thickness[i]);
        std::transform(rgb.begin(), rgb.end(), slabs + 3 * i, publicSlab);
      }
      return;
    }
    const Result result = compile(*desc);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = pellucid::transmittance(result.material, c, thickness[i]);
        const bool wall = result.material.thinWalled != 0;
        slabs[3 * i + c] = {value, value, wall ? result.report.channels[c].rho : 0};
      }
  });
}

double pellucidEvaluateTransmittance(const PellucidMaterial* material, uint32_t channel, double thickness) {
  if (material == nullptr || channel > 2) return std::numeric_limits<double>::quiet_NaN();
  return pellucid::transmittance(*material, channel, thickness);
}

uint32_t pellucidPresetCount(void) { return static_cast<uint32_t>(presets().size()); }

const char* pellucidPresetName(uint32_t index) {
  return index < presets().size() ? presets()[index].name : nullptr;
}

PellucidResult pellucidFindPreset(const char* name, PellucidMaterialDesc* desc) {
  const Preset* preset = name == nullptr ? nullptr : findPreset(name);
  if (preset == nullptr || desc == nullptr) return PELLUCID_ERROR_INVALID_ARGUMENT;
  pellucidInitMaterialDesc(desc);
  desc->ior = preset->ior;
  if (preset->layered) {
    desc->kind = PELLUCID_MATERIAL_PRESET;
    desc->preset = preset->name;
    return PELLUCID_OK;
  }
  std::copy(preset->scattering.begin(), preset->scattering.end(), desc->scattering);
  std::copy(preset->absorption.begin(), preset->absorption.end(), desc->absorption);
  return PELLUCID_OK;
}
