// OpenPBR's subsurface medium: what its color means, by photons, and beside the usual approximation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "material_monte_carlo.h"
#include "quadrature.h"
#include "transport.h"
#include "unit/material_complaint.h"

namespace {

using namespace pellucid::material;
using pellucid::test::Complaint;
using pellucid::test::note;

constexpr double kHalfSpace = std::numeric_limits<double>::infinity();

PellucidOpenPbr openPbr(double color, double g, double ior) {
  PellucidOpenPbr material;
  pellucidInitOpenPbr(&material);
  std::fill_n(material.subsurfaceColor, 3, color);
  material.subsurfaceScatterAnisotropy = g;
  material.specularIor = ior;
  return material;
}

PellucidMaterialDesc described(const PellucidOpenPbr& material) {
  PellucidMaterialDesc desc;
  Complaint complaint;
  EXPECT_EQ(pellucidDescribeOpenPbr(&material, &desc, note, &complaint), PELLUCID_OK)
      << complaint.field << ": " << complaint.sentence;
  return desc;
}

// The share of the light entering along the normal that photons bring back out.
double seenColor(double scattering, double absorption, double g, double ior, int photons) {
  const monte_carlo::Setup setup{{{scattering, absorption, kHalfSpace}}, ior, g, true};
  return monte_carlo::totals(setup, photons, 7).reflected / (1 - fresnelReflectance(1, ior));
}

// Kulla & Conty 2017, as the specification prints it: the albedo without a boundary.
double kullaConty(double color) {
  const double s = 4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
  return 1 - s * s;
}

TEST(OpenPbr, DefaultsAreTheSpecifications) {
  PellucidOpenPbr material;
  pellucidInitOpenPbr(&material);
  const PellucidMaterialDesc desc = described(material);
  EXPECT_EQ(desc.kind, static_cast<uint32_t>(PELLUCID_MATERIAL_COEFFICIENTS));
  EXPECT_EQ(desc.ior, 1.5);
  EXPECT_EQ(desc.g, 0);
  const double radius[] = {1, 0.5, 0.25};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR((desc.scattering[c] + desc.absorption[c]) * radius[c], 1, 1e-12) << "1 / mean free path";
  EXPECT_NEAR(desc.scattering[0], desc.scattering[2] * 0.25, 1e-12) << "a gray color has one albedo";
}

TEST(OpenPbr, UnitsScaleTheRadius) {
  PellucidOpenPbr material = openPbr(0.5, 0, 1.4);
  material.millimetersPerUnit = 10;
  material.subsurfaceRadius = 0.3;
  const PellucidMaterialDesc desc = described(material);
  EXPECT_NEAR(desc.scattering[0] + desc.absorption[0], 1 / 3.0, 1e-12);
}

// The ends of the range need no search.
TEST(OpenPbr, WhiteAbsorbsNothingAndBlackScattersNothing) {
  const PellucidMaterialDesc white = described(openPbr(1, 0.5, 1.5)), black = described(openPbr(0, 0, 1.5));
  EXPECT_EQ(white.absorption[0], 0);
  EXPECT_NEAR(white.scattering[0], 1, 1e-12);
  EXPECT_EQ(black.scattering[0], 0);
  PellucidMaterial compiled;
  EXPECT_EQ(pellucidCompileMaterial(&white, &compiled, nullptr, nullptr, nullptr), PELLUCID_OK);
  EXPECT_EQ(pellucidCompileMaterial(&black, &compiled, nullptr, nullptr, nullptr), PELLUCID_OK);
}

// The medium is solved for isotropic scattering, and similarity does the rest: the first events of a beam
// along the normal are not similar. The bounds are the differences in docs/materials.md, rounded up.
TEST(OpenPbr, PhotonsSeeTheColor) {
  constexpr int kPhotons = 10000;
  struct Case {
    double ior, g, color, similarity;
  };
  for (const auto& [ior, g, color, similarity] :
       {Case{1, 0, 0.5, 0}, Case{1.5, 0, 0.2, 0}, Case{1.5, 0, 0.8, 0}, Case{1.5, 0.8, 0.2, 0.015},
        Case{1.5, 0.8, 0.8, 0.005}, Case{1.5, -0.5, 0.2, 0.06}, Case{1.5, -0.5, 0.8, 0.01}}) {
    const PellucidMaterialDesc desc = described(openPbr(color, g, ior));
    const double seen = seenColor(desc.scattering[0], desc.absorption[0], g, ior, kPhotons);
    const double noise = 4 * std::sqrt(color * (1 - color) / kPhotons);  // four standard deviations
    EXPECT_NEAR(seen, color, noise + similarity) << ior << ' ' << g << ' ' << color;
  }
}

// Kulla and Conty's albedo is fitted to diffuse light without a boundary: under that light it is good to .015.
// Along the normal it is darker, and behind a boundary darker still.
TEST(OpenPbr, TheSolverHasTheColorAndKullaAndContyAreDarker) {
  for (const double color : {0.2, 0.5, 0.8, 0.95}) {
    double brightest = color;
    for (const double ior : {1.0, 1.3, 1.4, 1.5}) {
      const Angles angles = makeAngles(ior);
      const auto halfSpace = [&](double scattering) {
        return Medium(angles, {scattering, 1 - scattering}).slab(kHalfSpace);
      };
      const double entering = 1 - fresnelReflectance(1, ior);
      const double solved = described(openPbr(color, 0, ior)).scattering[0];
      EXPECT_NEAR(halfSpace(solved).reflectanceNormal / entering, color, 1e-6);
      const Slab approximate = halfSpace(kullaConty(color));
      EXPECT_LT(approximate.reflectanceNormal / entering, brightest - 0.01) << color << ' ' << ior;
      brightest = approximate.reflectanceNormal / entering;
      if (ior == 1) {
        EXPECT_NEAR(approximate.reflectance, color, 0.015);
      }
    }
  }
}

TEST(OpenPbr, WrongValuesAreNamed) {
  const std::pair<const char*, void (*)(PellucidOpenPbr&)> rows[] = {
      {"subsurfaceColor[1]: 1.2", [](auto& m) { m.subsurfaceColor[1] = 1.2; }},
      {"subsurfaceRadius: 0", [](auto& m) { m.subsurfaceRadius = 0; }},
      {"subsurfaceRadius: ", [](auto& m) { m.subsurfaceRadius = 1e30; }},
      {"subsurfaceRadiusScale[2]: -1", [](auto& m) { m.subsurfaceRadiusScale[2] = -1; }},
      {"subsurfaceScatterAnisotropy: 1", [](auto& m) { m.subsurfaceScatterAnisotropy = 1; }},
      {"specularIor: nan", [](auto& m) { m.specularIor = NAN; }},
      {"millimetersPerUnit: 0", [](auto& m) { m.millimetersPerUnit = 0; }}};
  for (const auto& [words, change] : rows) {
    PellucidOpenPbr material;
    pellucidInitOpenPbr(&material);
    change(material);
    PellucidMaterialDesc desc;
    Complaint complaint;
    EXPECT_NE(pellucidDescribeOpenPbr(&material, &desc, note, &complaint), PELLUCID_OK);
    EXPECT_TRUE((complaint.field + ": " + complaint.sentence).starts_with(words)) << complaint.sentence;
  }
  PellucidMaterialDesc desc;
  EXPECT_EQ(pellucidDescribeOpenPbr(nullptr, &desc, nullptr, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
}

}  // namespace
