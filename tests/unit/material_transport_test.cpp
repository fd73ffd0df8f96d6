// The exact solver: analytic limits, published values, an independent doubling code, Monte Carlo.
#include <gtest/gtest.h>

#include <Eigen/LU>
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

// Doubling from a thin layer in which light scatters at most once; second order in the layer's depth.
struct Doubled {
  Eigen::MatrixXd reflection, transmission;
};

Doubled doubled(const Angles& angles, const Coefficients& c, double thickness, int doublings) {
  const Eigen::Index n = angles.mu.size();
  const double depth = thickness * c.extinction() / std::ldexp(1.0, doublings);
  const Eigen::VectorXd inverse = angles.mu.cwiseInverse();
  // Diamond initialization (Wiscombe 1976): centered differences over the layer.
  const Eigen::MatrixXd scatter = c.albedo() / 2 * depth / 2 * inverse * angles.weight.transpose();
  const Eigen::MatrixXd loss = Eigen::MatrixXd((depth / 2 * inverse).asDiagonal()) - scatter;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd gain = (identity + loss).inverse();
  const Eigen::MatrixXd bounce = gain * scatter;
  const Eigen::MatrixXd core = (identity - bounce * bounce).inverse();
  Doubled layer;
  layer.transmission = 2 * core * gain - identity;
  layer.reflection = 2 * core * bounce * gain;
  for (int i = 0; i < doublings; ++i) {
    const Eigen::MatrixXd inner = (identity - layer.reflection * layer.reflection).inverse();
    const Eigen::MatrixXd through = inner * layer.transmission;
    layer.reflection = layer.reflection + layer.transmission * layer.reflection * through;
    layer.transmission = layer.transmission * through;
  }
  return layer;
}

TEST(MaterialTransport, EigenmodesAgreeWithDoubling) {
  for (const double ior : {1.0, 1.4}) {
    const Angles angles = makeAngles(ior);
    for (const Coefficients c : {Coefficients{1, 0.1}, {0.2, 1}, {3, 0}}) {
      const Medium medium(angles, c);
      for (const double d : {0.05, 1.0, 6.0}) {
        const Doubled reference = doubled(angles, c, d, 22);
        const Response own = medium.layer(d);
        EXPECT_LT((own.near - reference.reflection).cwiseAbs().maxCoeff(), 1e-7) << ior << ' ' << d;
        EXPECT_LT((own.far - reference.transmission).cwiseAbs().maxCoeff(), 1e-7) << ior << ' ' << d;
      }
    }
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

// van de Hulst 1980: a slab of 2 mean free paths, albedo 0.9, g = 0.75, normal incidence, no boundaries.
TEST(MaterialTransport, VanDeHulstByMonteCarlo) {
  monte_carlo::Setup setup{{{9, 1, 0.2}}, 1, 0.75, true};
  const monte_carlo::Totals slab = monte_carlo::totals(setup, 400000, 1);
  // Four standard deviations of a share p of 400000 photons: 4 sqrt(p (1 - p) / N).
  EXPECT_NEAR(slab.reflected, 0.09739, 0.0019);
  EXPECT_NEAR(slab.transmitted, 0.66096, 0.0030);
}

TEST(MaterialTransport, SlabAgreesWithMonteCarlo) {
  const Angles angles = makeAngles(1.4);
  const Medium medium(angles, {0.74, 0.032});
  const Slab slab = medium.slab(2);
  monte_carlo::Setup setup{{{0.74, 0.032, 2}}, 1.4};
  const monte_carlo::Totals lambertian = monte_carlo::totals(setup, 200000, 2);
  EXPECT_NEAR(lambertian.transmitted, slab.transmittance, 0.0045);  // four standard deviations
  EXPECT_NEAR(lambertian.reflected, slab.reflectance, 0.0043);
  setup.normalIncidence = true;
  EXPECT_NEAR(monte_carlo::totals(setup, 200000, 3).transmitted, slab.transmittanceNormal, 0.0045);
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
