// The exact solver: analytic limits, published values, an independent doubling code, Monte Carlo.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "material_monte_carlo.h"
#include "source.h"
#include "transport.h"

namespace {

using namespace pellucid::material;

constexpr double kHalfSpace = std::numeric_limits<double>::infinity();

TEST(MaterialTransport, PureAbsorberWithoutBoundaries) {
  const Angles angles = makeAngles(1);
  const Medium medium(angles, {0, 1});
  for (const double d : {0.01, 0.1, 1.0, 5.0, 20.0}) {
    double lambertian = 0;  // 2 E_3(d)
    for (const Node& node : gaussLegendre(400, 0, 1))
      lambertian += 2 * node.weight * node.x * std::exp(-d / node.x);
    const Slab slab = medium.slab(d);
    EXPECT_NEAR(slab.transmittance / lambertian, 1, 2e-6) << d;  // the quadrature's kink at mu = 0
    EXPECT_NEAR(slab.transmittanceNormal / std::exp(-d), 1, 1e-9) << d;
    EXPECT_NEAR(slab.reflectance, 0, 1e-12) << d;
  }
}

TEST(MaterialTransport, NoThicknessIsAClearWindow) {
  const Angles angles = makeAngles(1.4);
  const Slab slab = Medium(angles, {1, 0.1}).slab(0);
  // Both faces reflect r, all bounces summed: (1 - r) / (1 + r).
  const double r = fresnelReflectance(1, 1.4);
  EXPECT_NEAR(slab.transmittanceNormal, (1 - r) / (1 + r), 1e-9);
  double lambertian = 0;
  for (const Node& node : gaussLegendre(64, 0, 1)) {
    const double face = fresnelReflectance(node.x, 1.4);
    lambertian += 2 * node.weight * node.x * (1 - face) / (1 + face);
  }
  EXPECT_NEAR(slab.transmittance, lambertian, 1e-8);
}

TEST(MaterialTransport, WithoutAbsorptionNothingIsLost) {
  for (const double ior : {1.0, 1.4, 2.0}) {
    const Angles angles = makeAngles(ior);
    const Medium medium(angles, {1, 0});
    double entering = 0;  // 1 - the external reflectance
    for (const Node& node : gaussLegendre(64, 0, 1))
      entering += 2 * node.weight * node.x * (1 - fresnelReflectance(node.x, ior));
    for (const double d : {0.001, 1.0, 1000.0, 1e6}) {
      const Slab slab = medium.slab(d);
      EXPECT_NEAR(slab.transmittance + slab.reflectance, entering, 1e-6) << ior << ' ' << d;
      EXPECT_GT(slab.transmittance, 0);
    }
    EXPECT_NEAR(medium.slab(kHalfSpace).reflectance, entering, 1e-6);
    EXPECT_EQ(medium.slab(kHalfSpace).transmittance, 0);
  }
}

TEST(MaterialTransport, ThickSlabsFallWithTheCaseEigenvalue) {
  for (const Coefficients c : {Coefficients{0.74, 0.032}, {2.55, 0.0011}, {1, 1e-9}, {1, 0.3}}) {
    const Angles angles = makeAngles(1.4);
    const Medium medium(angles, c);
    const double kappa = caseEigenvalue(c), d = 30 / kappa;
    const double slope = std::log(medium.slab(d).transmittance / medium.slab(2 * d).transmittance) / d;
    EXPECT_NEAR(slope / kappa, 1, 1e-6) << c.scattering << ' ' << c.absorption;
    EXPECT_GT(medium.slab(300 / kappa).transmittance, 0);  // e^-300: no cancellation
  }
}

TEST(MaterialTransport, LayersOfOneMediumAreOneLayer) {
  const Angles angles = makeAngles(1.4);
  const Medium medium(angles, {0.74, 0.032});
  for (const double d : {0.5, 30.0, 300.0}) {
    const Slab whole = medium.slab(d);
    const Response a = medium.layer(0.2 * d), b = medium.layer(0.3 * d);
    const Response* const layers[] = {&a, &b, &b, &a};
    const Slab stacked = layeredSlab(angles, layers);
    EXPECT_NEAR(stacked.transmittance / whole.transmittance, 1, 1e-9);
    EXPECT_NEAR(stacked.transmittanceNormal / whole.transmittanceNormal, 1, 1e-9);
    EXPECT_NEAR(stacked.reflectance, whole.reflectance, 1e-11);
  }
}

TEST(MaterialTransport, CoarseAnglesAreGoodToTheirPromise) {
  for (const double ior : {1.0, 1.02, 1.4, 3.0}) {
    const Angles fine = makeAngles(ior), coarse = makeAngles(ior, AngleCount::Coarse);
    for (const double albedo : {0.0, 0.9, 0.999})
      for (const double d : {0.01, 0.5, 8.0}) {
        const Coefficients c{albedo, 1 - albedo};
        const double a = Medium(fine, c).slab(d).transmittance, b = Medium(coarse, c).slab(d).transmittance;
        EXPECT_NEAR(b / a, 1, 6e-5) << ior << ' ' << albedo << ' ' << d;
      }
  }
}

// Giovanelli 1955: n = 1.5, albedo 0.9, normal incidence; 0.2600 with the 0.04 of the outer face.
TEST(MaterialTransport, Giovanelli) {
  const Angles angles = makeAngles(1.5);
  const Medium medium(angles, {90, 10});
  // By reciprocity the radiance that leaves along the normal under unit radiance from everywhere.
  const Response response = medium.respond(kHalfSpace, angles.reflectance, angles.entrance);
  const double r = fresnelReflectance(1, 1.5);
  const double total = r + (1 - r) * response.near(angles.normal, 0) / (1.5 * 1.5);
  EXPECT_NEAR(total, 0.2600, 1e-4);  // the digits published
}

TEST(MaterialTransport, LayeredHalfSpaceAgreesWithMonteCarlo) {
  // The green channel of Donner & Jensen's three-layer skin.
  const Source source(
      rgbDescription(1.4, std::vector<Stack>(3, {{{{6, 0.21}, 0.25}, {{4, 0.019}, 0.20}}, {0.47, 0.1}})));
  monte_carlo::Setup setup{{{6, 0.21, 0.25}, {4, 0.019, 0.20}, {0.47, 0.1, kHalfSpace}}, 1.4};
  const double expected = monte_carlo::totals(setup, 100000, 4).reflected;
  EXPECT_NEAR(source.slabs(kHalfSpace)[0].reflectance, expected, 0.0062);  // four standard deviations
}

// Rows of slab_transmittance.csv, made by a separate adding/doubling solver: n, sigma_s', sigma_a, d; then
// T normal, T Lambertian, R Lambertian.
constexpr double kReference[][7] = {
    {1.3, 0.74, 0.032, 0.01, 0.962536682, 0.892536263, 0.0453248854},
    {1.3, 0.74, 0.032, 0.5, 0.793980924, 0.718046191, 0.172013152},
    {1.3, 0.74, 0.032, 0.863003, 0.696934549, 0.62214019, 0.234481869},
};

TEST(MaterialTransport, AgreesWithReferenceRows) {
  for (const auto& row : kReference) {
    const Angles angles = makeAngles(row[0]);
    const Slab slab = Medium(angles, {row[1], row[2]}).slab(row[3]);
    EXPECT_NEAR(slab.transmittanceNormal / row[4], 1, 1e-6);
    EXPECT_NEAR(slab.transmittance / row[5], 1, 1e-6);
    EXPECT_NEAR(slab.reflectance, row[6], 1e-6);
  }
}

}  // namespace
