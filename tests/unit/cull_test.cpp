// Which lights a plan drops: dropping never changes a pixel, and what plainly adds nothing is dropped.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference_frame.h"
#include "replay/frame.h"
#include "scene/camera.h"

namespace {

using namespace pellucid::harness;
using Vector = std::array<double, 3>;

constexpr int kSide = 12;

// Front and back depths anywhere between 2 and 60 mm, so that every part of the view holds a surface.
struct View {
  Capture capture;
  std::mt19937 random;

  explicit View(unsigned seed) : random(seed) {
    Capture& c = capture;
    c.name = "view " + std::to_string(seed);
    c.width = c.height = kSide;
    c.metersPerUnit = 0.001;
    const bool orthographic = seed % 3 == 0;
    const double zoom = uniform(0.3, 3);
    if (orthographic)
      c.clipFromView = {zoom / 20, 0, 0, 0, 0, -zoom / 20, 0, 0, 0, 0, -0.01, 0, uniform(-1, 1), 0, 0, 1};
    else
      c.clipFromView = {zoom, 0, 0, 0, 0, -zoom, 0, 0, uniform(-0.5, 0.5), 0, 0, -1, 0, 0, 0.1, 0};
    const double turn = uniform(0, 6.28), cosine = std::cos(turn), sine = std::sin(turn);
    c.viewFromWorld = {cosine, 0, -sine, 0, 0, 1, 0, 0, sine, 0, cosine, 0, 1, -2, 3, 1};
    c.frontDepth.image = Image(kSide, kSide, 1);
    c.backDepth.image = Image(kSide, kSide, 1);
    c.irradiance = Image(kSide, kSide, 3);
    for (size_t i = 0; i < c.irradiance.pixels(); ++i) {
      c.frontDepth.image.data[i] = static_cast<float>(uniform(2, 60));
      c.backDepth.image.data[i] = c.frontDepth.image.data[i] + static_cast<float>(uniform(0.1, 5));
    }
    c.material.assign(c.irradiance.pixels(), 1);
    c.materials.resize(1);
    if (seed % 5 < 2)
      for (size_t axis = 0; axis < 2; ++axis) {
        rect[axis] = static_cast<uint32_t>(random() % kSide);
        rect[2 + axis] = static_cast<uint32_t>(1 + random() % (kSide - rect[axis]));
      }
  }

  // Angle models in turn; pre-scaled ones too.
  ReplaySettings settings() {
    ReplaySettings s;
    s.features = PELLUCID_FEATURE_TRANSLUCENCY;
    s.translucency.angleModel = static_cast<PellucidAngleModel>(random() % 5);
    s.translucency.minimumDot = static_cast<float>(uniform(-1, 0));
    s.translucency.prescaleAngle = random() % 2;
    s.translucency.constantViewDirection = random() % 4 == 0;
    if (random() % 2) s.translucency.cameraThickness = 1;
    s.renderRect = rect;
    return s;
  }

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
  Vector vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

  Light light() {
    Light l;
    l.type = static_cast<PellucidLightType>(random() % 3);
    l.position = vector(60);
    l.direction = vector(1);
    if (random() % 2) l.range = uniform(5, 60);
    l.outerConeAngle = uniform(0.05, 1.57);
    l.intensity = 1000;
    return l;
  }

  // A map around the light's direction that holds something in front of nearly every point.
  static void addMap(Light& l) {
    ShadowMap map;
    map.depth.encoding = PELLUCID_DEPTH_DISTANCE;
    map.depth.image = Image(1, 1, 1, 0.01f);
    const bool point = l.type != PELLUCID_LIGHT_DIRECTIONAL;
    const Vector to = {l.position[0] + l.direction[0], l.position[1] + l.direction[1],
                       l.position[2] + l.direction[2]};
    map.viewFromWorld = point ? lookAt(l.position, to, {0, 1, 0})
                              : lookAt({-300 * l.direction[0], -300 * l.direction[1], -300 * l.direction[2]},
                                       {0, 0, 0}, {0, 1, 0});
    map.clipFromWorld =
        multiply(point ? perspective(2.8, 1, {0.01, 1000, true}) : orthographic(400, 400, {1, 1000, true}),
                 *map.viewFromWorld);
    l.shadowMaps = {map};
  }

  std::array<uint32_t, 4> rect = {0, 0, kSide, kSide};
};

PellucidMaterial material() {
  PellucidMaterial m{};
  for (int c = 0; c < 3; ++c) {
    m.transmittance[c][0] = 1;
    m.transmittance[c][1] = 0.1f;
    m.reflectance[c] = 0.5f;
  }
  return m;
}

PellucidPlan planOf(const Capture& capture, const ReplaySettings& settings) {
  FrameData data;
  makeFrame(capture, {material()}, settings, data);
  PellucidPlan plan;
  EXPECT_EQ(pellucidBuildPlan(&data.frame, nullptr, &plan), PELLUCID_OK);
  return plan;
}

std::string reasonOf(const Capture& capture, const ReplaySettings& settings) {
  const PellucidPlan plan = planOf(capture, settings);
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].what == std::string("light")) return plan.skips[i].reason;
  return "";
}

// Whether the light adds nothing, bit for bit, to any pixel of the rect: irradiance is 0 in these captures,
// so that the reference's frame is the translucency alone.
bool isDark(const View& view, const ReplaySettings& s) {
  const Image image = pellucid::test::referenceOf(view.capture, {material()}, s);
  for (uint32_t y = 0; y < view.rect[3]; ++y)
    for (uint32_t x = 0; x < view.rect[2]; ++x) {
      const float* pixel = image.at(static_cast<int>(view.rect[0] + x), static_cast<int>(view.rect[1] + y));
      if (pixel[0] != 0 || pixel[1] != 0 || pixel[2] != 0) return false;
    }
  return true;
}

Light between(const Light& a, const Light& b, double t) {
  Light light = a;
  const auto mix = [t](double from, double to) { return from + (to - from) * t; };
  for (size_t i = 0; i < 3; ++i) {
    light.position[i] = mix(a.position[i], b.position[i]);
    light.direction[i] = mix(a.direction[i], b.direction[i]);
  }
  light.range = a.range > 0 && b.range > 0 ? mix(a.range, b.range) : a.range;
  light.outerConeAngle = mix(a.outerConeAngle, b.outerConeAngle);
  return light;
}

// On the way from a light that adds something to one that does not, the last light that does stays. What is dropped
// adds nothing, and most of what adds nothing is dropped.
TEST(Cull, LightsJustInsideOfTheBorderStay) {
  std::map<std::string, int> reasons;
  int borders = 0, dark = 0, found = 0;
  for (unsigned seed = 0; seed < 4000; ++seed) {
    View view(seed);
    const ReplaySettings s = view.settings();
    const Light from = view.light();
    Light to = view.light();
    to.type = from.type;
    const bool mapped = view.random() % 3 == 0;
    const auto darkAt = [&](double t) {
      Light light = between(from, to, t);
      if (mapped) View::addMap(light);
      view.capture.lights = {light};
      return isDark(view, s);
    };
    const bool isBright = !darkAt(0);
    EXPECT_TRUE(!isBright || reasonOf(view.capture, s).empty()) << view.capture.name;
    const bool endsDark = darkAt(1);
    EXPECT_TRUE(endsDark || reasonOf(view.capture, s).empty()) << view.capture.name;
    if (!endsDark) continue;
    if (!mapped) ++dark, found += !reasonOf(view.capture, s).empty();  // maps add darkness that no plan looks for
    if (!isBright) continue;
    ++borders;
    double bright = 0, firstDark = 1;
    for (int i = 0; i < 45; ++i) {
      const double middle = 0.5 * (bright + firstDark);
      (darkAt(middle) ? firstDark : bright) = middle;
    }
    EXPECT_FALSE(darkAt(bright));
    EXPECT_EQ(reasonOf(view.capture, s), "") << view.capture.name << " at " << bright;
    // At the end of the way the plan drops it for one of its reasons, or it has none.
    darkAt(1);
    ++reasons[reasonOf(view.capture, s)];
  }
  EXPECT_GT(borders, 400);
  EXPECT_GT(found, dark * 7 / 10) << "of " << dark;
  EXPECT_EQ(reasons.size(), 4u) << "every reason is on the way, and none";
}

TEST(Cull, FrontLightsAreDropped) {
  View view(1);
  Light light;
  light.type = PELLUCID_LIGHT_DIRECTIONAL;
  const Matrix& m = view.capture.viewFromWorld;
  light.direction = {-m[2], -m[6], -m[10]};  // along the view
  view.capture.lights = {light};
  ReplaySettings s;
  s.translucency.angleModel = PELLUCID_ANGLE_COSINE;
  EXPECT_EQ(reasonOf(view.capture, s), "no pixel's view ray passes its angle test");
  EXPECT_EQ(planOf(view.capture, s).activeLights, 0u);

  // Normals decide pixel by pixel, and the thickness view shows what the light would pass.
  s.translucency.angleModel = PELLUCID_ANGLE_NORMAL;
  EXPECT_EQ(reasonOf(view.capture, s), "");
  s.translucency.angleModel = PELLUCID_ANGLE_COSINE;
  s.debugView = PELLUCID_DEBUG_THICKNESS;
  EXPECT_EQ(reasonOf(view.capture, s), "");

  // What is gathered comes from around, whatever the angle.
  s.debugView = PELLUCID_DEBUG_NONE;
  s.translucency.angleModel = PELLUCID_ANGLE_NORMAL;
  s.translucency.gatherSamples = 8;
  View::addMap(view.capture.lights[0]);
  EXPECT_EQ(reasonOf(view.capture, s), "");
}

}  // namespace
