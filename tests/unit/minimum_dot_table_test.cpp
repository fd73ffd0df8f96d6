// Measured tables of minimum dots: where entries point, and what a swing makes of known light.
#include "cli/measure_dots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "reference/minimum_dot.h"
#include "scene/vector.h"

namespace {

using namespace pellucid::harness;

double dot(const Vector3& a, const Vector3& b) { return glm::dot(toGlm(a), toGlm(b)); }

// Lookups in the direction of an entry give the entry. Values are a function of the direction, so that
// entries that share one agree.
TEST(MinimumDotTable, EntriesLieWhereLookupsFindThem) {
  const auto value = [](const Vector3& d) {
    return static_cast<float>(-0.5 - 0.2 * d[0] + 0.1 * d[1] * d[2]);
  };
  for (const DotTable& table :
       {DotTable{false, 36, {0.3, 0.1, 1}, {0.1, 2, 0}}, DotTable{false, 1, {1, 0, 0}, {0, 0, 1}},
        DotTable{true, 3, {0, 0, 1}, {0, 1, 0}}, DotTable{true, 8, {0.3, 0.1, 1}, {0.1, 2, 0}}}) {
    const std::vector<Vector3> directions = lightDirections(table);
    TranslucencySettings s;
    s.angleModel = table.sphere ? PELLUCID_ANGLE_MINIMUM_DOT_SPHERE : PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH;
    for (size_t i = 0; i < 3; ++i) {
      s.faceVector[i] = static_cast<float>(table.face[i]);
      s.upAxis[i] = static_cast<float>(table.up[i]);
    }
    for (const Vector3& d : directions) s.minimumDotTable.push_back(value(d));
    for (const Vector3& d : directions) {
      EXPECT_NEAR(dot(d, d), 1, 1e-12);
      Light light;
      light.direction = {-d[0], -d[1], -d[2]};
      // Settings are floats.
      EXPECT_NEAR(reference::minimumDot(s, light), static_cast<double>(value(d)), 1e-5);
    }
  }
}

TEST(MinimumDotTable, SwingsFromBesideTheLightAboutTheUpAxis) {
  const DotTable table{false, 4, {0, 0, 1}, {0, 1, 0}};
  std::vector<double> dots;
  measureMinimumDots(table, {2, 0.5}, [&](const Vector3& toLight, const Vector3& toEye) {
    EXPECT_NEAR(dot(toEye, toEye), 1, 1e-12);
    EXPECT_NEAR(toEye[1], 0, 1e-12);
    dots.push_back(dot(toLight, toEye));
    return 0.0;
  });
  ASSERT_EQ(dots.size(), 4u * 5);
  const double expected[] = {0, 0, -std::sqrt(0.5), -std::sqrt(0.5), -1};
  for (size_t i = 0; i < dots.size(); ++i) EXPECT_NEAR(dots[i], expected[i % 5], 1e-12) << i;
}

// Light that grows from a dot of m on as the factor of equation 4.6 does: it passes the threshold t of its
// maximum at m - t (1 + m). Linear light is interpolated without error but for the four decimals, where no
// step lies between m and the entry.
TEST(MinimumDotTable, FindsWhereLightBegins) {
  for (const bool sphere : {false, true}) {
    const DotTable table{sphere, sphere ? 4 : 12, {0, 0, 1}, {0, 1, 0}};
    const double t = 0.2;
    const auto begin = [](const Vector3& toLight) { return -0.4 - 0.3 * toLight[0]; };
    const std::vector<double> dots =
        measureMinimumDots(table, {900, t}, [&](const Vector3& toLight, const Vector3& toEye) {
          const double m = begin(toLight);
          return std::max(0.0, (m - dot(toLight, toEye)) / (1 + m));
        });
    const std::vector<Vector3> directions = lightDirections(table);
    ASSERT_EQ(dots.size(), directions.size());
    for (size_t i = 0; i < dots.size(); ++i) {
      const double m = begin(directions[i]);
      EXPECT_NEAR(dots[i], m - t * (1 + m), 0.5001e-4) << i;
    }
  }
}

}  // namespace
