// The float64 reference end to end, without diffusion unless named: light, occlusion, output. Thickness in every convention
// of depth is the camera's (camera_test.cpp) and that of the agreement tests in tests/gpu.
#include "reference/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/error.h"
#include "reference/ambient.h"
#include "reference/translucency.h"
#include "reference_captures.h"

namespace pellucid::harness::reference {
namespace {

Image debugView(const Capture& c, PellucidDebugView view, bool source = 0) {
  Settings s;
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  s.debugView = view;
  s.translucency.cameraThickness = source;
  return compute(c, {burleyMaterial(1)}, s).image;
}

// Sun straight from behind: travels towards the camera.
Light backLight() {
  Light light;
  light.direction = {0, 0, 1};
  light.intensity = 3;
  return light;
}

// Each band alone against the integral of the clamped cosine times the basis, whose definition this is.
TEST(AmbientReference, IrradianceIsTheIntegralOfRadiance) {
  const auto basis = [](int i, const glm::dvec3& w) {
    const double x = w.x, y = w.y, z = w.z;
    const double of[9] = {0.282095,
                          0.488603 * y,
                          0.488603 * z,
                          0.488603 * x,
                          1.092548 * x * y,
                          1.092548 * y * z,
                          0.315392 * (3 * z * z - 1),
                          1.092548 * x * z,
                          0.546274 * (x * x - y * y)};
    return of[i];
  };
  const glm::dvec3 normals[] = {{0, 0, 1},
                                {0, 1, 0},
                                {1, 0, 0},
                                glm::normalize(glm::dvec3(1, -2, 3)),
                                glm::normalize(glm::dvec3(-2, 1, 0.5))};
  for (int i = 0; i < 9; ++i)
    for (const glm::dvec3& n : normals) {
      // Radiance 1 besides, so that no irradiance is below 0.
      Harmonics environment{};
      environment[0] = {1 / 0.282095, 1 / 0.282095, 1 / 0.282095};
      environment[static_cast<std::size_t>(i)][1] += 0.5;
      double sum = 0;
      constexpr int kSteps = 400;
      for (int t = 0; t < kSteps; ++t)
        for (int p = 0; p < 2 * kSteps; ++p) {
          const double theta = (t + 0.5) / kSteps * 3.14159265358979,
                       phi = (p + 0.5) / kSteps * 3.14159265358979;
          const glm::dvec3 w(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                             std::cos(theta));
          const double solid = std::sin(theta) * 3.14159265358979 / kSteps * 3.14159265358979 / kSteps;
          sum += (1 + 0.5 * basis(i, w)) * std::max(glm::dot(n, w), 0.0) * solid;
        }
      // The integral's steps and the constants' digits.
      EXPECT_NEAR(Ambient::irradiance(environment, n).y, sum, 1e-4) << "coefficient " << i;
      EXPECT_NEAR(Ambient::irradiance(environment, n).x, 3.14159265358979, 1e-5);
    }
}

// Area of the cap that faces the rays by more than a cosine, 2 pi R^2 (1 - cosine), and the light on it after
// diffusion, over that area, are those of the body and not of the camera.
TEST(ReferenceCamera, ShearedViewsSeeTheBodyOfStraightOnes) {
  constexpr double kCosine = 0.35, kCap = 2 * std::numbers::pi * 64 * (1 - kCosine);
  double light[2];
  for (const bool sheared : {false, true}) {
    std::vector<double> cosines(80 * 80);
    const Capture c = obliqueBall(sheared, cosines.data(),
                                  [](const glm::dvec3& point) { return 1 + 0.9 * std::sin(2 * point.x); });
    const SurfaceReader surfaces(c);
    Settings settings;
    settings.features = PELLUCID_FEATURE_DIFFUSION;
    const Image image = compute(c, {burleyMaterial(1)}, settings).image;
    double area = 0, sum = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y * c.width + x);
        if (!(cosines[pixel] > kCosine)) continue;
        const std::optional<Surface> s = surfaces.at(x, y);
        ASSERT_TRUE(s);
        // Planes of 3 x 3 quads, 1.5 mm of a ball of 8 mm.
        EXPECT_NEAR(-glm::dot(s->normal, s->ray), cosines[pixel], 0.1);
        const SurfaceReader::Footprint f = surfaces.footprint(x, y, *s);
        const double part = 4 * glm::length(glm::cross(f.halfX, f.halfY));
        area += part;
        sum += part * static_cast<double>(image.at(x, y)[0]);
      }
    // Pixels at the cap's rim: some 200 of 3,000, each counted whole or not at all.
    EXPECT_NEAR(area, kCap, 0.01 * kCap) << sheared;
    light[sheared] = sum / area;
  }
  EXPECT_NEAR(light[1], light[0], 0.01 * light[0]);
}

// A plane with a step of 5 mm through the middle of quads, and a pixel of another material by itself.
TEST(ReferenceSurface, QuadsHaveTheNormalOfTheirPlane) {
  Capture c = facingPlane(9, 7, 0.5);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const glm::dvec2 p = planePoint(c, x + 0.5, y + 0.5);
      *c.frontDepth.image.at(x, y) = static_cast<float>(100 + 0.5 * p.x - 0.25 * p.y + (x > 4 ? 5 : 0));
    }
  c.material[0] = 2;
  const SurfaceReader surfaces(c);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5, -0.25, 1));
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const std::optional<Surface> s = surfaces.at(x, y);
      ASSERT_TRUE(s);
      const glm::dvec3 expected = x + y == 0 ? glm::dvec3(0, 0, 1) : normal;
      // Of pixels that no quad holds, the neighbor across the step counts a thousandth.
      EXPECT_NEAR(glm::distance(s->normal, expected), 0, 2e-3) << x << ", " << y;
    }
}

// Rounding turns pixels' normals four times as far as quads'.
TEST(ReferenceSurface, QuadsSmoothTheRoundingOfDepths) {
  Capture c = facingPlane(40, 40, 0.25);
  for (std::size_t i = 0; i < c.frontDepth.image.data.size(); ++i)
    c.frontDepth.image.data[i] += static_cast<float>(0.01 * std::sin(1.7 * double(i * i)));
  const SurfaceReader surfaces(c);
  double pixels = 0, quads = 0;
  for (int y = 2; y < 38; ++y)
    for (int x = 2; x < 38; ++x) {
      const Surface s = *surfaces.at(x, y);
      pixels += std::acos(std::min(surfaces.facet(s).z, 1.0)) / (36 * 36);
      quads += std::acos(std::min(s.normal.z, 1.0)) / (36 * 36);
    }
  EXPECT_LT(quads, 0.25 * pixels) << quads << " of " << pixels;
}

// Slab 4 mm thick facing the camera, lit from behind, dark in front.
Capture backLitSlab() {
  Capture c = facingPlane(4, 4, 1);
  c.irradiance = Image(4, 4, 3);
  c.backDepth.image = Image(4, 4, 1, 104.0f);
  c.lights.push_back(backLight());
  return c;
}

// Orthographic map of a light at z = -204 looking along +z; stores the slab's back face 100 in front of it.
ShadowMap mapBehindSlab() {
  ShadowMap map;
  map.depth = {Image(8, 8, 1, 100.0f), PELLUCID_DEPTH_VIEW_Z};
  map.clipFromWorld = {0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 1.0 / 400, 0, 0, 0, 204.0 / 400, 1};
  map.viewFromWorld = Matrix{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, -204, 1};
  return map;
}

// One pixel that is infinite, NaN or negative has no light, and leaves its surroundings as they are.
TEST(Reference, InfinityInInputsCountsAsNaNDoes) {
  const Capture plane = facingPlane(24, 24, 0.5);
  const auto with = [&](float value) {
    Capture c = plane;
    c.irradiance.at(12, 12)[0] = value;
    return compute(c, {burleyMaterial(0.7)}, {}).image;
  };
  const Image expected = with(0);
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity(), -1.0f})
    EXPECT_EQ(with(value).data, expected.data) << value;
  EXPECT_GT(expected.at(12, 12)[1], expected.at(12, 12)[0]);
}

TEST(Reference, SlabTransmitsThroughTheReflectance) {
  Capture c = backLitSlab();
  for (const bool withMap : {false, true}) {
    if (withMap) c.lights[0].shadowMaps = {mapBehindSlab()};
    const Image view = debugView(c, PELLUCID_DEBUG_IRRADIANCE);
    EXPECT_NEAR(view.at(2, 1)[0], 3 * std::exp(-2 * 4) / 0.5, 1e-7) << withMap;  // E T / rho
  }
  c.metersPerUnit = 0.0005;
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_THICKNESS).at(2, 1)[1], 2, 1e-6);
}

TEST(Reference, SurfaceNearerThanTheMapHasThicknessZero) {
  Capture c = backLitSlab();
  c.lights[0].shadowMaps = {mapBehindSlab()};
  c.lights[0].shadowMaps[0].depth.image = Image(8, 8, 1, 105.0f);
  EXPECT_EQ(debugView(c, PELLUCID_DEBUG_THICKNESS).at(1, 1)[1], 0);
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_IRRADIANCE).at(1, 1)[0], 3 / 0.5, 1e-6);
}

// Light 30 degrees off the normal: the light's path through the slab is longer, its cosine smaller; the
// camera's thickness stays.
TEST(Reference, ObliqueLightGoesTheLongWay) {
  const double angle = std::numbers::pi / 6;
  Capture c = backLitSlab();
  c.lights[0].direction = {std::sin(angle), 0, std::cos(angle)};
  ShadowMap map = mapBehindSlab();
  // Sheared so that the map's rays run along the light, depth still planar in z.
  map.depth.encoding = PELLUCID_DEPTH_DEVICE;
  map.depth.image = Image(8, 8, 1, 0.25f);  // z = -104
  map.clipFromWorld[8] = -0.1 * std::tan(angle);
  map.clipFromWorld[12] = -0.1 * std::tan(angle) * 100;
  c.lights[0].shadowMaps = {map};
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_THICKNESS).at(1, 1)[1], 4 / std::cos(angle), 1e-5);
  const double expected = 3 * std::cos(angle) * std::exp(-2 * 4 / std::cos(angle)) / 0.5;
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_IRRADIANCE).at(1, 1)[0], expected, 1e-7);
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_THICKNESS, 1).at(1, 1)[2], 4, 1e-5);
}

TEST(Reference, CameraThicknessIsTurnedToTheNormal) {
  Capture c = backLitSlab();
  // Front faces tilted by 36.9 degrees, 4 mm ahead of back faces.
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x)
      for (Image* depth : {&c.frontDepth.image, &c.backDepth.image})
        *depth->at(x, y) += static_cast<float>(0.75 * planePoint(c, x + 0.5, 0).x);
  const Image thickness = debugView(c, PELLUCID_DEBUG_THICKNESS),
              light = debugView(c, PELLUCID_DEBUG_IRRADIANCE);
  EXPECT_NEAR(thickness.at(1, 1)[0], 4, 1e-6);
  EXPECT_NEAR(thickness.at(1, 1)[2], 3.2, 1e-5);
  EXPECT_NEAR(light.at(1, 1)[0], 3 * 0.8 * std::exp(-2 * 3.2) / 0.5, 1e-6);
}

TEST(Reference, OccluderInFrontOfTheBackFace) {
  Capture c = backLitSlab();
  c.lights[0].shadowMaps = {mapBehindSlab()};
  // Nearer to the light than the slab's back face at 100: an occluder 10 mm behind the slab.
  // Texels around that of the pixel count, too.
  for (const int x : {3, 4, 5})
    for (const int y : {2, 3, 4}) *c.lights[0].shadowMaps[0].depth.image.at(x, y) = 90;
  const Image light = debugView(c, PELLUCID_DEBUG_THICKNESS);
  EXPECT_NEAR(light.at(2, 2)[1], 14, 1e-4);
  const Image camera = debugView(c, PELLUCID_DEBUG_OCCLUSION, 1);
  EXPECT_EQ(camera.at(2, 2)[0], 0);
  EXPECT_NEAR(camera.at(0, 0)[0], 1 - 0.9 * 0.9, 1e-6)
      << "texels beside the occluder have a tenth along each axis";
}

TEST(Reference, TransmittanceModels) {
  Capture c = backLitSlab();
  Settings s;
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  s.debugView = PELLUCID_DEBUG_TRANSMITTANCE;
  const auto transmitted = [&](const PellucidMaterial& m) { return compute(c, {m}, s).image.at(1, 1)[0]; };
  PellucidMaterial m = gaussianMaterial(9);
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
  EXPECT_NEAR(transmitted(m), std::exp(-16.0 / 18), 1e-6);
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_SINH_EXP;
  const float p[5] = {0.5f, 0.25f, 0.5f, 0.125f, 1};
  std::copy_n(p, 5, m.transmittance[0]);
  EXPECT_NEAR(transmitted(m), 0.5 / std::sinh(1.5) + 0.125 * std::exp(-4.0), 1e-6);
  m.transmittanceModel = 99;
  EXPECT_THROW(transmitted(m), InputError);
}

TEST(Reference, OutputIsAlbedoTimesDiffusedIrradiance) {
  Capture c = backLitSlab();
  c.irradiance = Image(4, 4, 3, 0.5f);
  c.albedo = Image(4, 4, 3, 0.25f);
  const Result result = compute(c, {burleyMaterial(1)}, Settings{});
  EXPECT_NEAR(result.image.at(2, 2)[0], 0.25 * (0.5 + 3 * std::exp(-8.0) / 0.5), 1e-6);
}

// A pixel that is wanted sees all others all the same.
TEST(Reference, OnlyWantedPixelsAreComputed) {
  Capture c = facingPlane(9, 7, 0.3);
  paint(c, [](glm::dvec2 p) { return 2 + p.x + p.y; });
  for (const std::uint32_t features : {1u, 2u, 3u}) {
    Settings some;
    some.features = features;
    const Image whole = compute(c, {burleyMaterial(1)}, some).image;
    some.wanted.assign(c.material.size(), 0);
    some.wanted[20] = some.wanted[31] = 1;
    const Image image = compute(c, {burleyMaterial(1)}, some).image;
    for (std::size_t i = 0; i < image.data.size(); ++i)
      EXPECT_EQ(image.data[i], some.wanted[i / 3] ? whole.data[i] : 0) << i << ", features " << features;
  }
  Settings wrong;
  wrong.wanted.assign(5, 1);
  EXPECT_THROW(compute(c, {burleyMaterial(1)}, wrong), InputError);
}

TEST(Reference, BadInputIsRefused) {
  void (*const changes[])(Capture&) = {[](Capture& c) { c.material[3] = 2; },
                                       [](Capture& c) { c.backDepth.image = Image(3, 4, 1); },
                                       [](Capture& c) { c.metersPerUnit = 0; },
                                       [](Capture& c) { c.clipFromView[2] = 0.1; },
                                       [](Capture& c) { c.clipFromView[0] = 0; },
                                       [](Capture& c) {
                                         c.lights[0].shadowMaps = {mapBehindSlab()};
                                         c.lights[0].shadowMaps[0].viewFromWorld.reset();
                                       }};
  for (const auto& change : changes) {
    Capture c = backLitSlab();
    change(c);
    EXPECT_THROW(compute(c, {burleyMaterial(1)}, Settings{}), InputError) << &change - changes;
  }
}

// ---- Minimum dots: entries and blends by light direction

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
    return minimumDot(s, fromDirection(std::cos(a), height, -std::sin(a)));
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
    return minimumDot(s, fromDirection(x, y, z));
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
  EXPECT_NEAR(minimumDot(s, light), -9 / 64.0, 1e-9);
}

TEST(MinimumDot, TableMustFit) {
  TranslucencySettings s;
  s.angleModel = kMinimumDotSphere;
  s.minimumDotTable.assign(10, 0);
  EXPECT_THROW(minimumDot(s, fromDirection(0, 0, 1)), InputError);
  s.minimumDotTable.assign(9, 0);
  EXPECT_EQ(minimumDot(s, fromDirection(0, 0, 1)), 0);
  s.minimumDotTable[4] = 0.5f;
  EXPECT_THROW(minimumDot(s, fromDirection(0, 0, 1)), InputError);
  s.minimumDotTable[4] = 0;
  s.faceVector = {0, -2, 0};
  EXPECT_THROW(minimumDot(s, fromDirection(0, 0, 1)), InputError);
}

}  // namespace
}  // namespace pellucid::harness::reference
