// Named polynomials of `--set`.
#include "cli/settings.h"

#include <gtest/gtest.h>

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

// Values known of Whelan 2009, eqs. 4.4 and 4.5, with as many digits; x = .5 is 120 degrees between the
// directions to eye and light, 1 is 180.
TEST(Settings, PolynomialsTakeTheKnownValues) {
  EXPECT_NEAR(value("quadratic", 0.5), -0.0136, 0.5e-4);
  EXPECT_NEAR(value("quadratic", 1), 0.867, 0.5e-3);
  EXPECT_NEAR(value("cubic", 0.5), 0.032, 0.5e-3);
  // Chosen ends.
  EXPECT_EQ(value("quadratic", 0), 0);
  EXPECT_EQ(value("cubic", 0), 0);
  EXPECT_NEAR(value("cubic", 1), 1, 1e-6);
  EXPECT_NEAR(value("cubic", 1e-4) / 1e-4, 0, 1e-3);  // no slope
}

TEST(Settings, LaterPolynomialsWin) {
  SettingsOptions options;
  options.set = {"polynomial=cubic", "polynomial=.1,.2,.3,.4"};
  EXPECT_EQ(options.parse().translucency.anglePolynomial, (std::array<float, 4>{0.1f, 0.2f, 0.3f, 0.4f}));
}

TEST(Settings, DebugViewsAreTheirNames) {
  const std::pair<const char*, PellucidDebugView> views[] = {{"thickness", PELLUCID_DEBUG_THICKNESS},
                                                             {"transmittance", PELLUCID_DEBUG_TRANSMITTANCE},
                                                             {"occlusion", PELLUCID_DEBUG_OCCLUSION},
                                                             {"irradiance", PELLUCID_DEBUG_IRRADIANCE}};
  for (const auto& [name, view] : views) {
    SettingsOptions options;
    options.debug = name;
    EXPECT_EQ(options.parse().debugView, view) << name;
    EXPECT_EQ(debugOption(options.parse()), name);
  }
}

}  // namespace
