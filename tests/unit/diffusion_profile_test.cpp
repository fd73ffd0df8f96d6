// The profile over distances that edges are summed with.
#include "diffusion_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

// Red has Burley's profile, green a pair of Gaussians, blue one.
PellucidMaterial mixedMaterial() {
  PellucidMaterial m{};
  m.gaussianCount = 2;
  const double variances[3][2] = {{0.5, 6}, {0.4, 3}, {0.7, 1}},
               weights[3][2] = {{0.5, 0.5}, {0.3, 0.7}, {1, 0}};
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 2; ++k) {
      m.gaussianVariance[c][k] = static_cast<float>(variances[c][k]);
      m.gaussianWeight[c][k] = static_cast<float>(weights[c][k]);
    }
    m.radius[c] = 8;
  }
  m.burleyDistance[0] = 0.8f;
  return m;
}

double profile(const PellucidMaterial& m, int c, double r) {
  if (const auto d = static_cast<double>(m.burleyDistance[c]); d > 0)
    return (std::exp(-r / d) + std::exp(-r / (3 * d))) / (8 * std::numbers::pi * d * r);
  double sum = 0;
  for (uint32_t k = 0; k < m.gaussianCount; ++k) {
    const auto v = static_cast<double>(m.gaussianVariance[c][k]);
    sum +=
        static_cast<double>(m.gaussianWeight[c][k]) / (2 * std::numbers::pi * v) * std::exp(-r * r / (2 * v));
  }
  return sum;
}

double fallOf(uint32_t bits, int c) { return ((bits >> 10 * c) & 1023u) / 1023.0 * PELLUCID_MOST_FALL; }

TEST(DiffusionProfile, DistancesHaveTheProfileAndItsDerivatives) {
  const PellucidMaterial m = mixedMaterial();
  const shared::KernelConstants k = kernelConstants(m, FineFilters::TwoOfPlanes, true);
  EXPECT_FLOAT_EQ(k.reach.x, 8);
  int compared = 0;
  for (uint32_t i = 0; i < PELLUCID_DISTANCE_ENTRIES - 1; i += 5) {
    const uint32_t at = std::bit_cast<uint32_t>(k.reach.y) + (i << PELLUCID_DISTANCE_SHIFT);
    const double r = std::sqrt(static_cast<double>(std::bit_cast<float>(at)));
    if (r < 0.01) continue;  // where differences have no digits left
    for (int c = 0; c < 3; ++c) {
      const double value = profile(m, c, r), h = 1e-3 * r;
      const double above = profile(m, c, r + h), below = profile(m, c, r - h);
      if (value < 1e-12) continue;  // beyond what a half of light can show
      const auto bits = static_cast<uint32_t>(k.distance[i][c]);
      // The last bits of the one are the other's.
      EXPECT_NEAR(std::bit_cast<float>(bits), value, 4e-3 * value) << r << ", channel " << c;
      const double curved = ((r + h) * above - 2 * r * value + (r - h) * below) / (h * h * r);
      EXPECT_NEAR(std::bit_cast<float>(bits << 16), curved, 0.01 * std::abs(curved) + 0.02 * value / (r * r))
          << r << ", channel " << c;
      // r^2 grows by 4 h / r from below to above.
      const double fall = std::log(below / above) / (4 * h / r);
      EXPECT_NEAR(fallOf(k.distance[i].w, c), std::min(fall, double{PELLUCID_MOST_FALL}),
                  0.5 * PELLUCID_MOST_FALL / 1023 + 1e-3 * fall)
          << r << ", channel " << c;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

// An integral over rings, which the table of what lies within a distance must be.
TEST(DiffusionProfile, EnergyWithinADistanceIsTheIntegral) {
  const PellucidMaterial m = mixedMaterial();
  const shared::KernelConstants k = kernelConstants(m, FineFilters::TwoOfPlanes, true);
  for (int c = 0; c < 3; ++c) {
    double within = 0, r = 0;
    for (uint32_t i = 0; i < PELLUCID_DISTANCE_ENTRIES; i += 12) {
      const uint32_t at = std::bit_cast<uint32_t>(k.reach.y) + (i << PELLUCID_DISTANCE_SHIFT);
      const double end = std::sqrt(static_cast<double>(std::bit_cast<float>(at)));
      constexpr int kSteps = 200;
      for (int s = 0; s < kSteps; ++s) {
        const double middle = r + (end - r) * (s + 0.5) / kSteps;
        within += 2 * std::numbers::pi * middle * profile(m, c, middle) * (end - r) / kSteps;
      }
      r = end;
      EXPECT_NEAR(k.enclosed[i][c], within, 1e-4) << r << ", channel " << c;
    }
  }
}

// Burley's profile is evaluated where all channels have it: its rate is that of e^(-r / 3d) in base 2.
TEST(DiffusionProfile, RatesAreOfBurleyAlone) {
  PellucidMaterial m = mixedMaterial();
  EXPECT_EQ(kernelConstants(m, FineFilters::One, true).burley.w, 0) << "a channel of Gaussians";
  for (int c = 0; c < 3; ++c) m.burleyDistance[c] = 0.5f + static_cast<float>(c);
  const shared::KernelConstants k = kernelConstants(m, FineFilters::One, true);
  EXPECT_EQ(k.burley.w, 1);
  for (int c = 0; c < 3; ++c) {
    const double d = static_cast<double>(m.burleyDistance[c]), r = 2.5;
    EXPECT_NEAR(std::exp2(-static_cast<double>(k.burley[c]) * r), std::exp(-r / (3 * d)), 1e-6) << c;
  }
}

// Planes alone need none, and neither does what does not diffuse.
TEST(DiffusionProfile, DistancesAreOfSumsAlone) {
  EXPECT_EQ(kernelConstants(mixedMaterial(), FineFilters::One, false).reach.x, 0);
  EXPECT_EQ(kernelConstants(PellucidMaterial{}, FineFilters::TwoOfPlanes, true).reach.x, 0);
}

}  // namespace
}  // namespace pellucid
