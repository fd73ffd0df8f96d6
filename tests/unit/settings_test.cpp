// Named polynomials of `--set`.
#include "cli/settings.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace pellucid::harness;

double value(const std::string& name, double x) {
  SettingsOptions options;
  options.set = {"polynomial=" + name};
  double sum = 0, power = 1;
  for (const float c : options.parse().translucency.anglePolynomial) {
    sum += static_cast<double>(c) * power;
    power *= x;
  }
  return sum;
}

// Whelan 2009, eqs. 4.4 and 4.5, at the ends of the angle between camera and light and where the quadratic is
// negative.
TEST(Settings, PolynomialsAreThoseOfTheThesis) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(value("quadratic", kPi / 2), 0.036, 5e-4);
  EXPECT_NEAR(value("cubic", kPi / 2), 0.002, 5e-4);
  EXPECT_NEAR(value("quadratic", kPi), 0.867, 5e-4);
  EXPECT_NEAR(value("cubic", kPi), 0.962, 5e-4);
  EXPECT_GT(value("quadratic", 1.67), 0);
  EXPECT_LT(value("quadratic", 1.69), 0);
  EXPECT_LT(value("quadratic", 2.14), 0);
  EXPECT_GT(value("quadratic", 2.16), 0);
}

}  // namespace
