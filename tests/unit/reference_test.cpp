// The float64 reference end to end, without diffusion unless named: thickness, light, occlusion, output.
#include "reference/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "common/error.h"
#include "reference/ambient.h"
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

// ---- Thickness -------------------------------------------------------------------------------------

// Depths along the camera axis and the exact chord of a sphere of radius 6 at distance 100.
struct SphereHit {
  double front, back, chord;
};

std::optional<SphereHit> hitSphere(const glm::dvec3& origin, const glm::dvec3& unitRay) {
  constexpr double kRadius = 6, kDistance = 100;
  const glm::dvec3 toCenter = glm::dvec3(0, 0, unitRay.z < 0 ? -kDistance : kDistance) - origin;
  const double along = glm::dot(toCenter, unitRay);
  const double squared = kRadius * kRadius - glm::dot(toCenter, toCenter) + along * along;
  if (squared <= 0.01) return std::nullopt;
  const double half = std::sqrt(squared);
  return SphereHit{(along - half) * std::abs(unitRay.z), (along + half) * std::abs(unitRay.z), 2 * half};
}

struct Convention {
  const char* name;
  Matrix clipFromView;
  bool reversed = false, orthographic = false;
};

constexpr double kNear = 80, kFar = 120, kRange = kFar - kNear, kScale = 14;

const Convention kConventions[] = {
    {"forward",
     {kScale, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, -kFar / kRange, -1, 0, 0, -kFar* kNear / kRange, 0}},
    {"reversed",
     {kScale, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, kNear / kRange, -1, 0, 0, kFar* kNear / kRange, 0},
     true},
    {"forward infinite", {kScale, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, -1, -1, 0, 0, -kNear, 0}},
    {"reversed infinite", {kScale, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0}, true},
    {"left-handed",
     {kScale, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, kFar / kRange, 1, 0, 0, -kFar* kNear / kRange, 0}},
    {"off-center, y up", {kScale, 0, 0, 0, 0, kScale, 0, 0, 0.2, -0.1, 0, -1, 0, 0, kNear, 0}, true},
    {"orthographic",
     {0.15, 0, 0, 0, 0, -0.15, 0, 0, 0, 0, -1 / kRange, 0, 0.1, 0, -kNear / kRange, 1},
     false,
     true},
    {"orthographic reversed",
     {0.15, 0, 0, 0, 0, -0.15, 0, 0, 0, 0, 1 / kRange, 0, 0.1, 0, kFar / kRange, 1},
     true,
     true},
};

// The sphere seen by a camera, and its chords (-1: missed). Projects points with the matrix itself.
struct SphereView {
  Capture capture;
  Image chord;
  int hits = 0;
};

SphereView sphereSeen(const Convention& convention, PellucidDepthEncoding encoding) {
  constexpr int kSize = 24;
  SphereView view{facingPlane(kSize, kSize, 1), Image(kSize, kSize, 1, -1.0f)};
  Capture& c = view.capture;
  c.clipFromView = convention.clipFromView;
  c.frontDepth.encoding = c.backDepth.encoding = encoding;
  const float empty = encoding == PELLUCID_DEPTH_VIEW_Z ? kNoDepth : convention.reversed ? 0.0f : 1.0f;
  c.frontDepth.image = c.backDepth.image = Image(kSize, kSize, 1, empty);
  const glm::dmat4 m = toGlm(convention.clipFromView);
  const double forward = m[2][3] > 0 ? 1 : -1;
  const auto stored = [&](double depth) {
    const double device = (m[2][2] * forward * depth + m[3][2]) / (m[2][3] * forward * depth + m[3][3]);
    return static_cast<float>(encoding == PELLUCID_DEPTH_VIEW_Z ? depth : device);
  };
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec2 ndc((x + 0.5) / kSize * 2 - 1, (y + 0.5) / kSize * 2 - 1);
      const glm::dvec2 scale(m[0][0], m[1][1]);
      glm::dvec3 origin(0), ray(0, 0, forward);
      if (convention.orthographic)
        origin = glm::dvec3((ndc - glm::dvec2(m[3])) / scale, 0);
      else  // at view z = forward, where w = 1
        ray = glm::normalize(glm::dvec3((ndc - forward * glm::dvec2(m[2])) / scale, forward));
      const std::optional<SphereHit> hit = hitSphere(origin, ray);
      if (!hit) continue;
      *c.frontDepth.image.at(x, y) = stored(hit->front);
      *c.backDepth.image.at(x, y) = stored(hit->back);
      *view.chord.at(x, y) = static_cast<float>(hit->chord);
      ++view.hits;
    }
  return view;
}

// Perspective chord 2 sqrt(R^2 - D^2 sin^2 phi), orthographic 2 sqrt(R^2 - rho^2): from device depths
// and from viewZ. Float device depths around 0.5 resolve 40 mm to about 1e-5.
TEST(Reference, SphereThicknessInEveryDepthConvention) {
  for (const Convention& convention : kConventions)
    for (const PellucidDepthEncoding encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z}) {
      const SphereView sphere = sphereSeen(convention, encoding);
      EXPECT_GT(sphere.hits, 100) << convention.name;
      const Image thickness = debugView(sphere.capture, PELLUCID_DEBUG_THICKNESS);
      for (std::size_t i = 0; i < thickness.pixels(); ++i)
        EXPECT_NEAR(thickness.data[3 * i], sphere.chord.data[i], 1e-4) << convention.name << " pixel " << i;
    }
}

// The cleared value, what lies beyond 0..1 and what is not a number hold no surface; the near end does.
TEST(Reference, EmptyDepths) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Convention& convention : kConventions) {
    const Camera camera(convention.clipFromView, 8, 8);
    const glm::dmat4 m = toGlm(convention.clipFromView);
    const double z = (m[2][3] > 0 ? 1 : -1) * kNear;
    const float nearest = static_cast<float>(std::round((m[2][2] * z + m[3][2]) / (m[2][3] * z + m[3][3])));
    EXPECT_NEAR(camera.planarDepth(nearest, PELLUCID_DEPTH_DEVICE).value_or(0), kNear, 1e-9)
        << convention.name;
    EXPECT_FALSE(camera.planarDepth(1 - nearest, PELLUCID_DEPTH_DEVICE)) << convention.name;
    for (const float outside : {-0.5f, 1.5f, nan})
      EXPECT_FALSE(camera.planarDepth(outside, PELLUCID_DEPTH_DEVICE)) << convention.name << " " << outside;
    for (const float nothing : {0.0f, -1.0f, 1e9f, std::numeric_limits<float>::infinity(), nan})
      EXPECT_FALSE(camera.planarDepth(nothing, PELLUCID_DEPTH_VIEW_Z)) << convention.name << " " << nothing;
  }
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

TEST(Reference, WedgeAndHollowSphereThickness) {
  Capture c = facingPlane(32, 1, 0.5);
  c.backDepth.image = Image(32, 1, 1);
  const double slope = std::tan(0.3);
  for (int x = 0; x < 32; ++x) {
    const double fromApex = planePoint(c, x + 0.5, 0.5).x + 8;
    *c.backDepth.image.at(x, 0) = static_cast<float>(100 + fromApex * slope);
  }
  Image view = debugView(c, PELLUCID_DEBUG_THICKNESS);
  for (int x = 0; x < 32; ++x) EXPECT_NEAR(view.at(x, 0)[0], (x + 0.5) * 0.5 * slope, 1e-5);

  // The nearest back face of a hollow sphere is the cavity's.
  const double outer = 8, inner = 5;
  for (int x = 0; x < 32; ++x) {
    const double rho = planePoint(c, x + 0.5, 0.5).x;
    const double front = -std::sqrt(outer * outer - rho * rho);
    const double back = std::abs(rho) < inner ? -std::sqrt(inner * inner - rho * rho) : -front;
    *c.frontDepth.image.at(x, 0) = static_cast<float>(100 + front);
    *c.backDepth.image.at(x, 0) = static_cast<float>(100 + back);
  }
  view = debugView(c, PELLUCID_DEBUG_THICKNESS);
  EXPECT_NEAR(view.at(16, 0)[0], std::sqrt(64 - 0.0625) - std::sqrt(25 - 0.0625), 2e-5);
  EXPECT_NEAR(view.at(30, 0)[0], 2 * std::sqrt(64 - 7.25 * 7.25), 2e-5);
}

// Mean of e^{-s t} over an orthographic sphere; s = 2 / mm. The pixel grid's own error is O(pixel^2).
TEST(Reference, MeanTransmittanceOfASphere) {
  constexpr int kSize = 400;
  const double radius = 1.5, pixel = 2 * radius / kSize, s = 2;
  Capture c = facingPlane(kSize, kSize, pixel);
  c.backDepth.image = Image(kSize, kSize, 1);
  c.lights.push_back(backLight());
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double rho = glm::length(planePoint(c, x + 0.5, y + 0.5));
      const double half = rho < radius ? std::sqrt(radius * radius - rho * rho) : 0;
      c.material[static_cast<std::size_t>(kSize * y + x)] = rho < radius;
      *c.frontDepth.image.at(x, y) = static_cast<float>(100 - half);
      *c.backDepth.image.at(x, y) = static_cast<float>(100 + half);
    }
  Settings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.debugView = PELLUCID_DEBUG_TRANSMITTANCE;
  settings.translucency.chordThickness = true;
  const Image view = compute(c, {burleyMaterial(1)}, settings).image;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < view.pixels(); ++i)
    if (c.material[i]) sum += view.data[3 * i], ++count;
  const double sr = s * radius;
  EXPECT_NEAR(sum / count, (1 - (1 + 2 * sr) * std::exp(-2 * sr)) / (2 * sr * sr), 1e-4);
}

// ---- Light and shadow ------------------------------------------------------------------------------

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

TEST(Reference, SurfaceNearerThanTheMapHasThicknessZero) {
  Capture c = backLitSlab();
  c.lights[0].shadowMaps = {mapBehindSlab()};
  c.lights[0].shadowMaps[0].depth.image = Image(8, 8, 1, 105.0f);
  EXPECT_EQ(debugView(c, PELLUCID_DEBUG_THICKNESS).at(1, 1)[1], 0);
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_IRRADIANCE).at(1, 1)[0], 3 / 0.5, 1e-6);
}

// Point light 100 mm behind the slab's back face with a perspective map, in all three encodings.
TEST(Reference, PointLightMapEncodingsAgree) {
  for (const PellucidDepthEncoding encoding :
       {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z, PELLUCID_DEPTH_DISTANCE}) {
    Capture c = backLitSlab();
    Light& light = c.lights[0];
    light.type = PELLUCID_LIGHT_POINT;
    light.position = {0, 0, -204};
    light.shadowMaps = {mapBehindSlab()};
    ShadowMap& map = light.shadowMaps[0];
    const double nearPlane = 10;
    map.clipFromWorld = {-8, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0, 1, 0, 0, nearPlane, 204};
    map.depth.encoding = encoding;
    const float device = static_cast<float>(nearPlane / 100);
    // On the axis planar and radial distances agree; off it only the planar encodings are constant.
    map.depth.image = Image(8, 8, 1, encoding == PELLUCID_DEPTH_DEVICE ? device : 100.0f);
    const Image view = debugView(c, PELLUCID_DEBUG_THICKNESS);
    for (int x = 0; x < 4; ++x) {
      const glm::dvec2 p = planePoint(c, x + 0.5, 0.5);
      const double distance = std::sqrt(p.x * p.x + p.y * p.y + 104.0 * 104.0);
      const double expected = encoding == PELLUCID_DEPTH_DISTANCE ? distance - 100 : 4 * distance / 104;
      EXPECT_NEAR(view.at(x, 0)[1], expected, 2e-5) << encoding << " x " << x;
      const double irradiance = 3 * 104 / std::pow(distance, 3) * std::exp(-2 * expected) / 0.5;
      EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_IRRADIANCE).at(x, 0)[0] / irradiance, 1, 1e-4);
    }
  }
}

TEST(Reference, LightTurnsWithTheCamera) {
  Capture c = backLitSlab();
  // View from world: a quarter turn about y.
  c.viewFromWorld = {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
  c.lights[0].direction = {1, 0, 0};
  EXPECT_NEAR(debugView(c, PELLUCID_DEBUG_IRRADIANCE).at(1, 1)[0], 3 * std::exp(-8.0) / 0.5, 1e-7);
}

// ---- Transmittance models and output ---------------------------------------------------------------

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

}  // namespace
}  // namespace pellucid::harness::reference
