// Minimum dots: the float64 reference's entries and blends by light direction, and measured tables of them.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "cli/measure_dots.h"
#include "common/error.h"
#include "reference/translucency.h"
#include "scene/vector.h"

namespace {

using namespace pellucid::harness;

Light fromDirection(double x, double y, double z) {
  Light light;
  light.direction = {-x, -y, -z};
  return light;
}

// The face looks along +x, so that sideways, cross(up, face), is -z.
TranslucencySettings azimuthTable() {
  TranslucencySettings s;
  s.angleModel = PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH;
  for (int i = 0; i < 36; ++i) s.minimumDotTable.push_back(static_cast<float>(-i) / 64);
  s.faceVector = {2, 0.5f, 0};  // its part along up does not count
  return s;
}

TEST(MinimumDot, AzimuthEntriesAndWrap) {
  const TranslucencySettings s = azimuthTable();
  const auto at = [&](double degrees, double height) {
    const double a = degrees * 3.14159265358979 / 180;
    return reference::minimumDot(s, fromDirection(std::cos(a), height, -std::sin(a)));
  };
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(at(10 * i, 0.3), -i / 64.0, 1e-9) << i;
  EXPECT_NEAR(at(45, 0), -4.5 / 64, 1e-9);
  EXPECT_NEAR(at(355, 0), -17.5 / 64, 1e-9) << "half way between the last entry and the first";
}

TEST(MinimumDot, SphereEntriesAreOctahedral) {
  TranslucencySettings s;
  s.angleModel = PELLUCID_ANGLE_MINIMUM_DOT_SPHERE;
  //                  -s,-f: down      -f        down
  s.minimumDotTable = {-0.9f, -0.1f, -0.9f, -0.2f, -0.5f, -0.3f, -0.9f, -0.4f, -0.9f};
  const auto at = [&](double x, double y, double z) {
    return reference::minimumDot(s, fromDirection(x, y, z));
  };
  EXPECT_NEAR(at(0, 1, 0), -0.5, 1e-7);
  EXPECT_NEAR(at(0, -1, 0), -0.9, 1e-7);
  EXPECT_NEAR(at(0, 0, 1), -0.4, 1e-7) << "where the face looks";
  EXPECT_NEAR(at(0, 0, -1), -0.1, 1e-7);
  EXPECT_NEAR(at(1, 0, 0), -0.3, 1e-7) << "sideways";
  EXPECT_NEAR(at(-1, 0, 0), -0.2, 1e-7);
  EXPECT_NEAR(at(0, 1, 1), -0.45, 1e-7);
}

TEST(MinimumDot, PointLightsAreSeenFromTheCenter) {
  TranslucencySettings s = azimuthTable();
  s.objectCenter = {10, 0, 5};
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  light.position = {10, 3, 1};  // sideways of the center: 90 degrees
  EXPECT_NEAR(reference::minimumDot(s, light), -9 / 64.0, 1e-9);
}

TEST(MinimumDot, TableMustFit) {
  TranslucencySettings s;
  s.angleModel = PELLUCID_ANGLE_MINIMUM_DOT_SPHERE;
  s.minimumDotTable.assign(10, 0);
  EXPECT_THROW(reference::minimumDot(s, fromDirection(0, 0, 1)), InputError);
}

// ---- Measured tables

double dot(const Vector3& a, const Vector3& b) { return glm::dot(toGlm(a), toGlm(b)); }

// Lookups in the direction of an entry give the entry. Values are a function of the direction, so that
// entries that share one agree.
TEST(MinimumDotTable, EntriesLieWhereLookupsFindThem) {
  const auto value = [](const Vector3& d) {
    return static_cast<float>(-0.5 - 0.2 * d[0] + 0.1 * d[1] * d[2]);
  };
  for (const DotTable& table :
       {DotTable{36, {0.3, 0.1, 1}, {0.1, 2, 0}}, DotTable{1, {1, 0, 0}, {0, 0, 1}}}) {
    const std::vector<Vector3> directions = lightDirections(table);
    TranslucencySettings s;
    s.angleModel = PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH;
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
  const DotTable table{4, {0, 0, 1}, {0, 1, 0}};
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
  const DotTable table{12, {0, 0, 1}, {0, 1, 0}};
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

}  // namespace
