// The material compiler through its C API.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "unit/material_complaint.h"

namespace {

using pellucid::test::Complaint;
using pellucid::test::note;

struct Compiled {
  PellucidMaterial material = {};
  PellucidMaterialReport report = {};
};

Compiled compile(const PellucidMaterialDesc& desc) {
  Compiled compiled;
  Complaint complaint;
  EXPECT_EQ(pellucidCompileMaterial(&desc, &compiled.material, &compiled.report, note, &complaint),
            PELLUCID_OK)
      << complaint.field << ": " << complaint.sentence;
  return compiled;
}

PellucidMaterialDesc described(double scattering, double absorption, double ior) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  std::fill_n(desc.scattering, 3, scattering);
  std::fill_n(desc.absorption, 3, absorption);
  desc.ior = ior;
  return desc;
}

PellucidMaterialDesc ofKind(uint32_t kind) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  desc.kind = kind;
  return desc;
}

PellucidMaterialDesc preset(const char* name, double ior = 0) {
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_PRESET);
  desc.preset = name;
  desc.ior = ior;
  return desc;
}

std::vector<double> logarithmic(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first * std::pow(last / first, i / (count - 1.0)));
  return values;
}

std::vector<PellucidSlab> slabs(const PellucidMaterialDesc& desc, const std::vector<double>& thickness) {
  std::vector<PellucidSlab> result(3 * thickness.size());
  EXPECT_EQ(pellucidMaterialSlabs(&desc, static_cast<uint32_t>(thickness.size()), thickness.data(),
                                  result.data(), nullptr, nullptr),
            PELLUCID_OK);
  return result;
}

// Largest relative error of the shader's T(d) over 0.01..20 mm where T > 1e-4, per channel.
std::array<double, 3> worstError(const PellucidMaterialDesc& desc, const PellucidMaterial& material) {
  const std::vector<double> thickness = logarithmic(0.01, 20, 211);
  const std::vector<PellucidSlab> exact = slabs(desc, thickness);
  std::array<double, 3> worst = {};
  for (std::size_t i = 0; i < thickness.size(); ++i)
    for (uint32_t c = 0; c < 3; ++c) {
      const double t = exact[3 * i + c].transmittance;
      if (t > 1e-4)
        worst[c] =
            std::max(worst[c], std::abs(pellucidEvaluateTransmittance(&material, c, thickness[i]) / t - 1));
    }
  return worst;
}

// Fractions of light: positive, at most 1, falling all the way.
void expectTransmittance(const PellucidMaterial& material) {
  for (uint32_t c = 0; c < 3; ++c) {
    double previous = 1 + 1e-6;  // float amplitudes
    for (double d = 0; d < 500; d = d * 1.1 + 0.001) {
      const double t = pellucidEvaluateTransmittance(&material, c, d);
      ASSERT_GE(t, 0) << c << ' ' << d;
      ASSERT_LE(t, previous) << c << ' ' << d;
      previous = t;
    }
  }
}

TEST(Material, FitsEveryPresetAtEveryIndex) {
  for (uint32_t i = 0; i < pellucidPresetCount(); ++i) {
    const std::string name = pellucidPresetName(i);
    if (name == "skin_three_layer") continue;
    for (const double ior : {1.0, 1.3, 1.4, 1.5}) {
      const PellucidMaterialDesc desc = preset(name.c_str(), ior);
      const Compiled compiled = compile(desc);
      EXPECT_EQ(compiled.report.ior, ior);
      expectTransmittance(compiled.material);
      // Without a Fresnel boundary the ballistic light of skin1's green and blue bends T more than the form
      // can follow: 0.17 and 0.24 %.
      const bool isSkin = (name == "skin1" && ior > 1) || name == "skin2";
      const std::array<double, 3> worst = worstError(desc, compiled.material);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(worst[c], isSkin ? 0.001 : 0.003) << name << ' ' << ior << ' ' << c;
        // Between the samples of the fit a little more than on them.
        EXPECT_LT(worst[c], compiled.report.channels[c].transmittanceError * 1.05 + 1e-5)
            << name << ' ' << ior;
      }
    }
  }
}

TEST(Material, DenseAndThinMediaGetARangeOfTheirOwn) {
  const PellucidMaterialDesc dense = described(500, 20, 1.4), thin = described(0.002, 0.001, 1.4);
  const Compiled a = compile(dense), b = compile(thin);
  EXPECT_LT(a.report.channels[0].minThickness, 1e-3);
  EXPECT_LT(a.report.channels[0].maxThickness, 1);
  EXPECT_GT(b.report.channels[0].maxThickness, 500);
  EXPECT_LT(a.report.channels[0].transmittanceError, 0.005);
  EXPECT_LT(b.report.channels[0].transmittanceError, 0.005);
  expectTransmittance(a.material);
  expectTransmittance(b.material);
}

TEST(Material, AlbedoUpToOne) {
  for (const double absorption : {1e-3, 1e-6, 1e-12, 0.0}) {
    const PellucidMaterialDesc desc = described(1, absorption, 1.4);
    const Compiled compiled = compile(desc);
    EXPECT_LT(worstError(desc, compiled.material)[0], 0.003) << absorption;
    EXPECT_GT(compiled.material.burleyDistance[0], 1);
    EXPECT_LE(compiled.material.reflectance[0], 1);
    expectTransmittance(compiled.material);
  }
  // Beyond the 20 mm fitted, T falls like 1/d.
  const PellucidMaterialDesc clear = described(1, 0, 1.4);
  const Compiled compiled = compile(clear);
  EXPECT_NEAR(
      pellucidEvaluateTransmittance(&compiled.material, 0, 100) / slabs(clear, {100})[0].transmittance, 1,
      0.01);
  // All that enters comes back: 1 less the Fresnel reflectance of the outer face under Lambertian light,
  // for n = 1.4 (1 - 0.076812).
  EXPECT_NEAR(compiled.report.channels[0].rho, 0.923188, 1e-5);
}

TEST(Material, PureAbsorber) {
  const PellucidMaterialDesc desc = described(0, 0.5, 1.3);
  const Compiled compiled = compile(desc);
  EXPECT_LT(worstError(desc, compiled.material)[0], 0.003);
  EXPECT_NEAR(compiled.report.channels[0].rho, 0, 1e-12);
  EXPECT_GT(compiled.material.reflectance[0], 0);  // shaders divide by it
  EXPECT_GT(compiled.material.burleyDistance[0], 0);
}

TEST(Material, SimilarityAndUnits) {
  PellucidMaterialDesc desc = described(10, 0.032, 1.4);
  desc.g = 0.926;
  const Compiled reduced = compile(described(0.74, 0.032, 1.4));
  EXPECT_NEAR(compile(desc).material.transmittance[0][1], reduced.material.transmittance[0][1], 1e-6);
  PellucidMaterialDesc centimeters = described(7.4, 0.32, 1.4);
  centimeters.millimetersPerUnit = 10;
  const Compiled same = compile(centimeters);
  EXPECT_NEAR(same.report.channels[0].scattering, 0.74, 1e-12);
  EXPECT_NEAR(same.material.transmittance[0][1], reduced.material.transmittance[0][1], 1e-6);
}

TEST(Material, SameInputSameOutput) {
  const PellucidMaterialDesc desc = preset("skin1");
  const Compiled a = compile(desc), b = compile(desc);
  EXPECT_EQ(std::memcmp(&a.material, &b.material, sizeof a.material), 0);
}

TEST(Material, GaussiansAndRadius) {
  for (uint32_t count = 1; count <= PELLUCID_MAX_GAUSSIANS; ++count) {
    PellucidMaterialDesc desc = preset("skin1");
    desc.gaussianCount = count;
    const Compiled compiled = compile(desc);
    ASSERT_EQ(compiled.material.gaussianCount, count);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) {
        EXPECT_GT(compiled.material.gaussianVariance[c][i], 0);
        sum += static_cast<double>(compiled.material.gaussianWeight[c][i]);
      }
      EXPECT_NEAR(sum, 1, 1e-6);
      const double x = static_cast<double>(compiled.material.radius[c] / compiled.material.burleyDistance[c]);
      EXPECT_NEAR(0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3), 1e-3, 1e-6);
    }
  }
}

TEST(Material, ExplicitGaussians) {
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_GAUSSIANS);
  desc.gaussianCount = 2;
  desc.gaussianVariance[0] = 0.5;
  desc.gaussianVariance[1] = 2;
  for (auto& weight : desc.gaussianWeight) {
    weight[0] = 1;
    weight[1] = 3;
  }
  const Compiled compiled = compile(desc);
  EXPECT_EQ(compiled.material.transmittanceModel, static_cast<uint32_t>(PELLUCID_TRANSMITTANCE_GAUSSIANS));
  EXPECT_FLOAT_EQ(compiled.material.gaussianWeight[1][1], 0.75f);
  // d'Eon & Luebke 2007: each term e^{-d^2 / 2v}.
  EXPECT_NEAR(pellucidEvaluateTransmittance(&compiled.material, 0, 1.5),
              0.25 * std::exp(-1.5 * 1.5) + 0.75 * std::exp(-1.5 * 1.5 / 4), 1e-6);
  const double r = static_cast<double>(compiled.material.radius[2]);
  EXPECT_NEAR(0.25 * std::exp(-r * r) + 0.75 * std::exp(-r * r / 4), 1e-3, 1e-6);
}

TEST(Material, BurleyDistance) {
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_BURLEY);
  std::fill_n(desc.burleyDistance, 3, 0.7);
  const Compiled burley = compile(desc);
  EXPECT_FLOAT_EQ(burley.material.burleyDistance[1], 0.7f);
  for (const double d : {0.0, 0.5, 3.0})
    EXPECT_NEAR(pellucidEvaluateTransmittance(&burley.material, 0, d),
                0.25 * std::exp(-d / 0.7) + 0.75 * std::exp(-d / 2.1), 1e-6);

  const double given[4] = {0.6, 1.5, 0.3, 0.2};
  for (auto& row : desc.transmittance) std::copy_n(given, 4, row);
  const Compiled curve = compile(desc);
  EXPECT_NEAR(pellucidEvaluateTransmittance(&curve.material, 2, 2.0),
              0.6 * std::exp(-3.0) + 0.3 * std::exp(-0.4), 1e-6);
}

TEST(Material, PresetsAreFound) {
  PellucidMaterialDesc desc;
  ASSERT_EQ(pellucidFindPreset("Whole Milk", &desc), PELLUCID_OK);
  EXPECT_EQ(desc.kind, static_cast<uint32_t>(PELLUCID_MATERIAL_COEFFICIENTS));
  EXPECT_EQ(desc.scattering[0], 2.55);
  EXPECT_EQ(desc.absorption[2], 0.014);
  EXPECT_EQ(desc.ior, 1.3);
  EXPECT_EQ(pellucidFindPreset("gravel", &desc), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_GE(pellucidPresetCount(), 12u);
  EXPECT_EQ(pellucidPresetName(pellucidPresetCount()), nullptr);
  for (uint32_t i = 0; i < pellucidPresetCount(); ++i) {
    ASSERT_EQ(pellucidFindPreset(pellucidPresetName(i), &desc), PELLUCID_OK);
    EXPECT_STREQ(compile(preset(pellucidPresetName(i))).report.name, pellucidPresetName(i));
  }
}

TEST(Material, ThreeLayerSkin) {
  const PellucidMaterialDesc desc = preset("skin_three_layer");
  const Compiled skin = compile(desc);
  // Donner & Jensen 2005 print no totals; Monte Carlo holds the solver (material_transport_test). Here:
  // reddish, and thin slabs are epidermis alone.
  EXPECT_GT(skin.report.channels[0].rho, skin.report.channels[1].rho);
  EXPECT_GT(skin.report.channels[1].rho, skin.report.channels[2].rho);
  const PellucidSlab thin = slabs(desc, {1e-4})[0];
  PellucidSlab clear;
  ASSERT_EQ(pellucidSlabTransport(1, 1, 1.4, 0, &clear, nullptr, nullptr), PELLUCID_OK);
  EXPECT_NEAR(thin.transmittance, clear.transmittance, 1e-3);
  expectTransmittance(skin.material);
}

PellucidMaterialDesc physiological(double melanin, double hemoglobin) {
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_SKIN);
  desc.melanin = melanin;
  desc.hemoglobin = hemoglobin;
  return desc;
}

// Donner & Jensen 2006, equations 1 and 2: eumelanin absorbs 1.3 times as much as pheomelanin in blue, and 2.2 times in red.
TEST(Skin, EumelaninIsDarkerThanPheomelanin) {
  PellucidMaterialDesc desc = physiological(0.05, 0.005);
  desc.melaninType = 0;
  const PellucidMaterial pheomelanin = compile(desc).material;
  desc.melaninType = 1;
  const PellucidMaterial eumelanin = compile(desc).material;
  for (int c = 0; c < 3; ++c) EXPECT_LT(eumelanin.reflectance[c], 0.9f * pheomelanin.reflectance[c]) << c;
}

TEST(Material, SkinByPhysiology) {
  const Compiled light = compile(physiological(0.002, 0.005)), dark = compile(physiological(0.2, 0.005)),
                 flushed = compile(physiological(0.002, 0.05));
  const auto rho = [](const Compiled& c, std::size_t channel) { return c.report.channels[channel].rho; };
  EXPECT_GT(rho(light, 0), 0.5);  // reflectance spectra of fair skin: 0.5 to 0.7 in the red
  EXPECT_LT(rho(light, 0), 0.7);
  EXPECT_GT(rho(light, 0), rho(light, 1));
  EXPECT_GT(rho(light, 1), rho(light, 2));
  EXPECT_LT(rho(dark, 0), 0.2);
  // Blood takes green before red.
  EXPECT_LT(rho(flushed, 1) / rho(light, 1), rho(flushed, 0) / rho(light, 0));
  expectTransmittance(light.material);
  expectTransmittance(dark.material);
}

void setSpectrum(PellucidMaterialDesc& desc, uint32_t count, const double* wavelength,
                 const double* scattering, const double* absorption) {
  desc.wavelengthCount = count;
  desc.wavelength = wavelength;
  desc.spectralScattering = scattering;
  desc.spectralAbsorption = absorption;
}

TEST(Material, FlatSpectrumIsRgb) {
  const double wavelength[] = {400, 700}, scattering[] = {2, 2}, absorption[] = {0.05, 0.05};
  const Compiled rgb = compile(described(2, 0.05, 1.4));
  for (const uint32_t illuminant : {PELLUCID_ILLUMINANT_D65, PELLUCID_ILLUMINANT_A, PELLUCID_ILLUMINANT_E}) {
    PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_SPECTRAL);
    setSpectrum(desc, 2, wavelength, scattering, absorption);
    desc.illuminant = illuminant;
    const Compiled spectral = compile(desc);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(spectral.report.channels[c].rho, rgb.report.channels[c].rho, 1e-4);  // coarser angles
      EXPECT_NEAR(spectral.material.burleyDistance[c], rgb.material.burleyDistance[c], 1e-4f);
      EXPECT_LT(worstError(desc, spectral.material)[c], 0.003);
    }
  }
}

TEST(Material, SpectrumIsIntegratedNotAveraged) {
  // Opaque above 560 nm, clear below: averaged coefficients would make blue dark as well.
  const double wavelength[] = {380, 559, 561, 780}, scattering[] = {1, 1, 1, 1},
               absorption[] = {0.01, 0.01, 1e3, 1e3};
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_SPECTRAL);
  setSpectrum(desc, 4, wavelength, scattering, absorption);
  const std::vector<PellucidSlab> exact = slabs(desc, {1.0});
  PellucidSlab clear;
  ASSERT_EQ(pellucidSlabTransport(1, 0.01, 1.4, 1, &clear, nullptr, nullptr), PELLUCID_OK);
  EXPECT_EQ(exact[0].transmittance, 0);  // cyan beyond Rec. 709: cut to 0
  EXPECT_NEAR(exact[2].transmittance / clear.transmittance, 1, 0.1);
  expectTransmittance(compile(desc).material);
}

TEST(Material, SlabTransport) {
  PellucidSlab slab;
  ASSERT_EQ(pellucidSlabTransport(0.74, 0.032, 1.3, 0.5, &slab, nullptr, nullptr), PELLUCID_OK);
  EXPECT_NEAR(slab.transmittance, 0.718046191, 1e-6);  // an independent adding/doubling solver
  const double halfSpace = std::numeric_limits<double>::infinity();
  ASSERT_EQ(pellucidSlabTransport(0.74, 0.032, 1.4, halfSpace, &slab, nullptr, nullptr), PELLUCID_OK);
  EXPECT_EQ(slab.transmittance, 0);
  EXPECT_NEAR(slab.reflectance, compile(preset("skin1")).report.channels[0].rho, 1e-12);
  Complaint complaint;
  EXPECT_EQ(pellucidSlabTransport(0.74, 0.032, 1.3, -1, &slab, note, &complaint),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(complaint.field, "thickness");
}

TEST(Material, ThinWallsTransmitTheSameAtEveryThickness) {
  PellucidMaterialDesc desc = ofKind(PELLUCID_MATERIAL_THIN_WALL);
  const double reflectance[] = {0.25, 0.5, 0}, transmittance[] = {0.5, 0.25, 1};
  std::copy_n(reflectance, 3, desc.wallReflectance);
  std::copy_n(transmittance, 3, desc.wallTransmittance);
  const Compiled wall = compile(desc);
  EXPECT_STREQ(wall.report.name, "thin_wall");
  EXPECT_EQ(wall.material.thinWalled, 1u);
  EXPECT_EQ(wall.material.gaussianCount, 0u) << "light does not spread sideways";
  const double thickness[] = {0, 3};
  PellucidSlab slabs[6];
  ASSERT_EQ(pellucidMaterialSlabs(&desc, 2, thickness, slabs, nullptr, nullptr), PELLUCID_OK);
  for (std::uint32_t c = 0; c < 3; ++c) {
    // Reflectances divide, so that they are 1e-4 at least.
    EXPECT_NEAR(wall.material.reflectance[c], reflectance[c], 1e-4);
    EXPECT_LE(wall.material.reflectance[c] + wall.material.wallTransmittance[c], 1.0f);
    for (const double d : thickness)
      EXPECT_NEAR(pellucidEvaluateTransmittance(&wall.material, c, d), transmittance[c], 2e-4);
    EXPECT_NEAR(slabs[3 + c].transmittance, transmittance[c], 2e-4);
    EXPECT_EQ(slabs[3 + c].reflectance, reflectance[c]);
  }
  std::fill_n(desc.burleyDistance, 3, 2.0);
  const Compiled spreads = compile(desc);
  EXPECT_EQ(spreads.material.gaussianCount, desc.gaussianCount);
  EXPECT_EQ(spreads.material.burleyDistance[1], 2.0f);
}

struct BadCase {
  const char* field;
  uint32_t kind;
  void (*spoil)(PellucidMaterialDesc&);
};

TEST(Material, BadInputNamesTheField) {
  static const double rising[] = {400, 500}, falling[] = {500, 400}, ultraviolet[] = {200, 300},
                      ones[] = {1, 1}, negative[] = {1, -1};
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  const auto coefficients = PELLUCID_MATERIAL_COEFFICIENTS, burley = PELLUCID_MATERIAL_BURLEY,
             gaussians = PELLUCID_MATERIAL_GAUSSIANS, wall = PELLUCID_MATERIAL_THIN_WALL,
             spectral = PELLUCID_MATERIAL_SPECTRAL, named = PELLUCID_MATERIAL_PRESET,
             skin = PELLUCID_MATERIAL_SKIN;
  using Desc = PellucidMaterialDesc;
  const BadCase cases[] = {
      {"scattering[1]", coefficients, [](Desc& d) { d.scattering[1] = -0.5; }},
      {"absorption[2]", coefficients, [](Desc& d) { d.absorption[2] = kNan; }},
      {"scattering[0]", coefficients, [](Desc& d) { d.scattering[0] = kInfinity; }},
      {"scattering[2]", coefficients, [](Desc& d) { d.scattering[2] = d.absorption[2] = 0; }},
      {"scattering[0]", coefficients, [](Desc& d) { d.scattering[0] = 1e9; }},
      {"ior", coefficients, [](Desc& d) { d.ior = 0.9; }},
      {"ior", coefficients, [](Desc& d) { d.ior = kNan; }},
      {"g", coefficients, [](Desc& d) { d.g = 1; }},
      {"millimetersPerUnit", coefficients, [](Desc& d) { d.millimetersPerUnit = -1; }},
      {"gaussianCount", coefficients, [](Desc& d) { d.gaussianCount = 9; }},
      {"gaussianCount", coefficients, [](Desc& d) { d.gaussianCount = 0; }},
      {"kind", 77, [](Desc&) {}},
      {"preset", named, [](Desc&) {}},
      {"preset", named, [](Desc& d) { d.preset = "gravel"; }},
      {"burleyDistance[0]", burley, [](Desc&) {}},
      {"transmittance[1]", burley,
       [](Desc& d) {
         std::fill_n(d.burleyDistance, 3, 1.0);
         for (auto& row : d.transmittance) row[0] = row[1] = 0.5;
         d.transmittance[1][0] = 2;
       }},
      {"gaussianVariance[5]", gaussians, [](Desc& d) { std::fill_n(d.gaussianVariance, 5, 1.0); }},
      {"gaussianWeight[0]", gaussians, [](Desc& d) { std::fill_n(d.gaussianVariance, 8, 1.0); }},
      {"wallReflectance[1]", wall, [](Desc& d) { d.wallReflectance[1] = 1.5; }},
      {"wallTransmittance[0]", wall, [](Desc& d) { d.wallTransmittance[0] = -0.5; }},
      {"wallTransmittance[2]", wall, [](Desc& d) { d.wallReflectance[2] = d.wallTransmittance[2] = 0.75; }},
      {"burleyDistance[1]", wall, [](Desc& d) { d.burleyDistance[0] = 1; }},
      {"wavelengthCount", spectral, [](Desc&) {}},
      {"wavelength[1]", spectral, [](Desc& d) { setSpectrum(d, 2, falling, ones, ones); }},
      {"wavelength", spectral, [](Desc& d) { setSpectrum(d, 2, ultraviolet, ones, ones); }},
      {"spectralAbsorption[1]", spectral, [](Desc& d) { setSpectrum(d, 2, rising, ones, negative); }},
      {"illuminant", spectral,
       [](Desc& d) {
         setSpectrum(d, 2, rising, ones, ones);
         d.illuminant = 3;
       }},
      {"melanin", skin, [](Desc& d) { d.melanin = 1.5; }},
      {"hemoglobin", skin, [](Desc& d) { d.hemoglobin = -1; }},
  };
  for (const BadCase& bad : cases) {
    PellucidMaterialDesc desc = described(1, 0.1, 1.4);
    desc.kind = bad.kind;
    bad.spoil(desc);
    Complaint complaint;
    PellucidMaterial material = {};
    EXPECT_EQ(pellucidCompileMaterial(&desc, &material, nullptr, note, &complaint),
              PELLUCID_ERROR_INVALID_ARGUMENT)
        << bad.field;
    EXPECT_EQ(complaint.field, bad.field);
    EXPECT_FALSE(complaint.sentence.empty());
    EXPECT_EQ(material.transmittance[0][0], 0.0f);  // untouched
  }
  PellucidMaterial material;
  EXPECT_EQ(pellucidCompileMaterial(nullptr, &material, nullptr, nullptr, nullptr),
            PELLUCID_ERROR_INVALID_ARGUMENT);
}

}  // namespace
