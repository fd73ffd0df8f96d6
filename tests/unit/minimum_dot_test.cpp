// Minimum dots: the float64 reference's entries and blends by light direction.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

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
  s.angleModel = kMinimumDotAzimuth;
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
  s.angleModel = kMinimumDotSphere;
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
  s.angleModel = kMinimumDotSphere;
  s.minimumDotTable.assign(10, 0);
  EXPECT_THROW(reference::minimumDot(s, fromDirection(0, 0, 1)), InputError);
  s.minimumDotTable.assign(9, 0);
  EXPECT_EQ(reference::minimumDot(s, fromDirection(0, 0, 1)), 0);
  s.minimumDotTable[4] = 0.5f;
  EXPECT_THROW(reference::minimumDot(s, fromDirection(0, 0, 1)), InputError);
  s.minimumDotTable[4] = 0;
  s.faceVector = {0, -2, 0};
  EXPECT_THROW(reference::minimumDot(s, fromDirection(0, 0, 1)), InputError);
}

}  // namespace
