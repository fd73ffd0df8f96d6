// Which lights a plan drops: dropping never changes a pixel, and what plainly adds nothing is dropped.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/reference.h"
#include "replay/frame.h"

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
};

PellucidMaterial material() {
  PellucidMaterial m{};
  m.structSize = sizeof m;
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

bool isDark(const Image& image) {
  return std::all_of(image.data.begin(), image.data.end(), [](float v) { return v == 0; });
}

// Irradiance is 0 in these captures, so the reference's frame is the translucency alone: it must be 0 bit
// for bit for a light that is dropped.
TEST(Cull, DroppedLightsAddNothing) {
  int dropped = 0, dark = 0, lights = 0;
  std::map<std::string, int> reasons;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    View view(seed);
    ReplaySettings s;
    s.features = PELLUCID_FEATURE_TRANSLUCENCY;
    s.translucency.angleModel = static_cast<PellucidAngleModel>(seed % 5);
    s.translucency.minimumDot = static_cast<float>(view.uniform(-1, 0));
    s.translucency.constantViewDirection = view.random() % 4 == 0;
    view.capture.lights = {view.light()};
    reference::Settings r;
    r.features = s.features;
    r.translucency = s.translucency;
    r.jobs = 1;
    ++lights;
    const bool nothing = isDark(reference::compute(view.capture, {material()}, r).image);
    dark += nothing;
    const std::string reason = reasonOf(view.capture, s);
    if (reason.empty()) continue;
    ++dropped;
    ++reasons[reason];
    EXPECT_TRUE(nothing) << view.capture.name << ": " << reason;
  }
  EXPECT_EQ(reasons.size(), 3u) << "every reason occurs";
  // Most of what is dark is found: the bounds are of use.
  EXPECT_GT(dropped, dark * 7 / 10) << dropped << " dropped of " << dark << " dark of " << lights;
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
  view.capture.normal = Image(kSide, kSide, 3, 1);
  EXPECT_EQ(reasonOf(view.capture, s), "");
  s.translucency.angleModel = PELLUCID_ANGLE_COSINE;
  s.debugView = PELLUCID_DEBUG_THICKNESS;
  EXPECT_EQ(reasonOf(view.capture, s), "");

  // What is gathered comes from around, whatever the angle.
  s.debugView = PELLUCID_DEBUG_NONE;
  s.translucency.gatherSamples = 8;
  EXPECT_NE(reasonOf(view.capture, s), "") << "nothing is gathered without a map";
  ShadowMap map;
  map.clipFromWorld = {0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0.5, 1};
  map.depth.encoding = PELLUCID_DEPTH_DEVICE;
  map.depth.image = Image(1, 1, 1, 0.5f);
  view.capture.lights[0].shadowMap = map;
  EXPECT_EQ(reasonOf(view.capture, s), "");
}

}  // namespace
