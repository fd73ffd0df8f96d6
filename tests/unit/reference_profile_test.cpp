// Radial profiles, their tables and the integral over a footprint.
#include "reference/profile.h"

#include <gtest/gtest.h>

#include "reference_captures.h"

namespace pellucid::harness::reference {
namespace {

GaussianProfile sixGaussianSkin() {  // d'Eon et al. 2007, red
  return {{0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41}, {0.233, 0.1, 0.118, 0.113, 0.358, 0.078}};
}

TEST(ReferenceProfile, TableIsWithinItsStatedError) {
  const std::array<Profile, 3> profiles = {BurleyProfile{0.1}, BurleyProfile{3}, sixGaussianSkin()};
  double radius = 0;
  for (const Profile& p : profiles) radius = std::max(radius, radiusOfTail(p, 1e-5));
  const ProfileTable table(profiles, radius);
  for (int c = 0; c < 3; ++c) {
    const Profile& p = profiles[static_cast<std::size_t>(c)];
    double highest = 0, worstRing = 0, worstCumulative = 0;
    for (double r = 1e-4; r < radius; r *= 1.003) {
      const double ring = table.value(r * r)[c] * 2 * std::numbers::pi * r;
      highest = std::max(highest, ringDensity(p, r));
      worstRing = std::max(worstRing, std::abs(ring - ringDensity(p, r)));
      worstCumulative = std::max(worstCumulative, std::abs(table.cumulativeEnergy(r)[c] - cumulative(p, r)));
    }
    EXPECT_LT(worstRing, 1e-6 * highest) << "profile " << c;
    EXPECT_LT(worstCumulative, 1e-6) << "profile " << c;
  }
}

TEST(ReferenceProfile, RadiusLeavesOutTheEnergyItStates) {
  for (const Profile& p : {Profile(BurleyProfile{0.7}), Profile(sixGaussianSkin())})
    for (const double fraction : {1e-2, 1e-5, 1e-8}) {
      const double radius = radiusOfTail(p, fraction);
      EXPECT_LE(1 - cumulative(p, radius), fraction);
      EXPECT_GT(1 - cumulative(p, 0.999 * radius), fraction);
    }
}

// A tiling's cells add up to the energy of the whole, wherever the receiver is: on a corner, on an edge,
// inside, above. Slab: int over the plane of R(sqrt(r^2 + t^2)) = 1 - cumulative(t).
TEST(ReferenceProfile, FootprintsTileThePlane) {
  const Profile burley = BurleyProfile{1};
  const double radius = radiusOfTail(burley, 1e-9);
  const ProfileTable table({burley, burley, burley}, radius);
  for (const glm::dvec3 receiver :
       {glm::dvec3(0, 0, 0), glm::dvec3(0.5, 0, 0), glm::dvec3(0.5, 0.1, 0), glm::dvec3(0.2, 0.3, 1e-3),
        glm::dvec3(0.2, 0.3, 0.7), glm::dvec3(1e-7, 0.1, 3)}) {
    double sum = 0;
    const double cell = 16;
    for (int y = -4; y < 4; ++y)
      for (int x = -4; x < 4; ++x) {
        const glm::dvec3 center((x + 0.5) * cell, (y + 0.5) * cell, 0);
        sum += integratedEnergy(table, {center - receiver, {cell / 2, 0, 0}, {0, cell / 2, 0}}).x;
      }
    EXPECT_NEAR(sum, 1 - burleyCumulative(receiver.z, 1), 1e-6)
        << receiver.x << " " << receiver.y << " " << receiver.z;
  }
}

// A Gaussian over a rectangle in its own plane or a parallel one: a product of error functions.
TEST(ReferenceProfile, GaussianFootprintIsAProductOfErrorFunctions) {
  const Profile gaussian = GaussianProfile{{1}, {1}};
  const ProfileTable table({gaussian, gaussian, gaussian}, radiusOfTail(gaussian, 1e-10));
  const double kInvSqrt2 = 1 / std::numbers::sqrt2;
  const auto integral = [&](double center, double half) {
    return 0.5 * (std::erf((center + half) * kInvSqrt2) - std::erf((center - half) * kInvSqrt2));
  };
  for (const double half : {0.05, 0.5, 3.0})
    for (const double height : {0.0, 0.2, 1.0})
      for (const glm::dvec2 center :
           {glm::dvec2(0, 0), glm::dvec2(half, 0), glm::dvec2(2 * half, -4 * half)}) {
        const Parallelogram p{{center, height}, {half, 0, 0}, {0, half, 0}};
        const double exact =
            integral(center.x, half) * integral(center.y, half) * std::exp(-height * height / 2);
        EXPECT_NEAR(integratedEnergy(table, p).x, exact, 1e-7) << half << " " << height;
      }
}

TEST(ReferenceProfile, SampledFootprintAgreesWithTheIntegralAtADistance) {
  const Profile burley = BurleyProfile{1};
  const ProfileTable table({burley, burley, burley}, 30);
  const Parallelogram p{{1.2, 0.4, 0.3}, {0.1, 0, 0.1}, {0, 0.15, 0}};
  const double exact = integratedEnergy(table, p).x;
  EXPECT_NEAR(sampledEnergy(table, p).x, exact, 1e-3 * exact);
}

}  // namespace
}  // namespace pellucid::harness::reference
