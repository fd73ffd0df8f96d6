// Burley's profile as a mixture of Gaussians, and how much of it lies at the pyramid's elements.
#include "pyramid_energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

// Of Gaussians of deviation s in the profile with d = 1; see pyramid_energy.cpp.
double density(double s) {
  return std::sqrt(2 / std::numbers::pi) / 4 * (std::exp(-s * s / 2) + std::exp(-s * s / 18));
}

// Over all deviations, by steps of their logarithm.
template <typename F>
double mixed(F&& ofGaussian) {
  constexpr double kStep = 0.01;
  double sum = 0;
  for (double x = -20; x < 5; x += kStep) {
    const double s = std::exp2(x);
    sum += ofGaussian(s, x) * density(s) * s * std::numbers::ln2 * kStep;
  }
  return sum;
}

double at(const EnergyFrom& from, double x) {
  const double i = (x - from.first) / EnergyFrom::kStep;
  const auto last = static_cast<double>(from.samples.size() - 1);
  if (i <= 0) return 0;
  if (i >= last) return 1;
  const auto low = static_cast<size_t>(i);
  return std::lerp(from.samples[low], from.samples[low + 1], i - std::floor(i));
}

TEST(PyramidEnergy, MixtureIsBurleysProfile) {
  for (const double r : {0.01, 0.1, 1.0, 3.0, 10.0}) {
    const double profile = (std::exp(-r) + std::exp(-r / 3)) / (8 * std::numbers::pi * r);
    const double mixture = mixed(
        [r](double s, double) { return std::exp(-r * r / (2 * s * s)) / (2 * std::numbers::pi * s * s); });
    EXPECT_NEAR(mixture, profile, 1e-4 * profile) << r;
  }
}

TEST(PyramidEnergy, OfBurleyIsThatOfItsGaussians) {
  for (int i = kFine; i < kElements; ++i) {
    const auto element = static_cast<Element>(i);
    const EnergyFrom gaussian = gaussianEnergy(element), burley = burleyEnergy(element);
    // Between samples, too.
    for (double x = -9; x < 10; x += 0.3)
      EXPECT_NEAR(at(burley, x), mixed([&](double, double s) { return at(gaussian, s + x); }), 2e-3)
          << i << " at " << x;
  }
}

// Far from all elements in width nothing or everything lies there.
TEST(PyramidEnergy, BeginsWithNothingAndEndsWithAll) {
  for (int i = kFine; i < kElements; ++i)
    for (const EnergyFrom& from :
         {gaussianEnergy(static_cast<Element>(i)), burleyEnergy(static_cast<Element>(i))}) {
      EXPECT_NEAR(from.samples.front(), 0, 1e-12);
      EXPECT_NEAR(from.samples.back(), 1, 1e-12);
      for (const double sample : from.samples) {
        EXPECT_GT(sample, -0.25);
        EXPECT_LT(sample, 1.25);
      }
    }
}

// Plans leave out levels by it.
TEST(PyramidEnergy, CoarserLevelsBeginWhereStated) {
  const EnergyFrom coarser = gaussianEnergy(kCoarser);
  for (double x = coarser.first; x <= kCoarserBegins; x += EnergyFrom::kStep)
    EXPECT_LE(at(coarser, x), 1e-3) << x;
  EXPECT_GT(at(coarser, kCoarserBegins + 2 * EnergyFrom::kStep), 1e-3);
}

}  // namespace
}  // namespace pellucid
