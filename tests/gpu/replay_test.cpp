// The promises about pixels: what is read, what is written, and that it is always the same.
#include "gpu_fixture.h"

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace pellucid::test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Replay = GpuTest;

void expectPixel(const Image& image, int x, int y, double r, double g, double b, double tolerance) {
  EXPECT_NEAR(image.at(x, y)[0], r, tolerance * r) << x << ", " << y;
  EXPECT_NEAR(image.at(x, y)[1], g, tolerance * g) << x << ", " << y;
  EXPECT_NEAR(image.at(x, y)[2], b, tolerance * b) << x << ", " << y;
}

// 1e-3: the promise; half output alone rounds by 5e-4.
constexpr double kConstant = 1e-3;

class Sizes : public GpuTest, public testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(Sizes, ConstantIrradianceStays) {
  const auto [width, height] = GetParam();
  Capture c = flatCapture(width, height);
  for (float& v : c.irradiance.data) v *= 1.2348f;  // not a half: rounding counts
  const Image out = replay(c, testMaterial());
  const auto check = [&](int x, int y) { expectPixel(out, x, y, 1.2348, 0.6174, 0.3087, kConstant); };
  for (int y = 0; y < height; y += std::max(1, height / 50))
    for (int x = 0; x < width; x += std::max(1, width / 50)) check(x, y);
  check(width - 1, height - 1);
}

// Blocks, groups and quads that the image cuts.
INSTANTIATE_TEST_SUITE_P(Replay, Sizes,
                         testing::Values(std::pair(1, 1), std::pair(3, 5), std::pair(64, 64),
                                         std::pair(121, 17), std::pair(244, 50), std::pair(500, 33),
                                         std::pair(1921, 1081)));

TEST_F(Replay, SlabTransmitsTOfItsThickness) {
  Capture c = flatCapture(16, 16, 2);
  c.lights = {backLight()};
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  const Image out = replay(c, testMaterial(), s);
  // E + T(2 mm) E_back / rho, with E_back = 3 and rho = 1/2.
  const double blue = 0.7 * std::exp(-4.0) + 0.3 * std::exp(-0.5);
  // 1e-5: float arithmetic over a few dozen operations.
  expectPixel(out, 8, 8, 1 + 6 * std::exp(-1.0), 0.5 + 6 * std::exp(-2.0), 0.25 + 6 * blue, 1e-5);
}

TEST_F(Replay, ShadowMapThicknessEqualsCameraThicknessOnASlab) {
  for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z, PELLUCID_DEPTH_DISTANCE}) {
    Capture c = flatCapture(16, 16, 2);
    c.lights = {backLight()};
    c.lights[0].shadowMaps = {flatShadowMap(-12, encoding)};
    ReplaySettings s = inFloats();
    s.debugView = PELLUCID_DEBUG_THICKNESS;
    const Image thickness = replay(c, testMaterial(), s);
    // Device depth of this map: 2^-24 of 100 mm.
    expectPixel(thickness, 5, 5, 2, 2, 2, 1e-5);
  }
}

TEST_F(Replay, OccludedBackIsDark) {
  Capture c = flatCapture(16, 16, 2);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-42, PELLUCID_DEPTH_VIEW_Z)};  // a body 30 mm behind the slab
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  s.translucency.cameraThickness = 1;
  expectPixel(replay(c, testMaterial(), s), 5, 5, 1, 0.5, 0.25, 1e-5);
  // Light space: 32 mm of thickness, e^{-16} of the light in red and e^{-8} in blue's slow part.
  s.translucency.cameraThickness = 0;
  expectPixel(replay(c, testMaterial(), s), 5, 5, 1 + 6 * std::exp(-16.0), 0.5, 0.25 + 1.8 * std::exp(-8.0),
              1e-5);
}

TEST_F(Replay, OutsideTheMapAndEmptyTexelsGiveNoLight) {
  for (const auto source : {0, 1}) {
    ReplaySettings s;
    s.translucency.cameraThickness = source;
    Capture c = flatCapture(8, 8, 2);
    c.lights = {backLight()};
    c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z)};
    c.lights[0].shadowMaps[0].clipFromWorld[12] = 5;  // the receiver is at ndc x = 5
    expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 0.5, 0.25, kConstant);
    for (const float nothing : {pellucid::harness::kNoDepth, 0.0f, -1.0f, kNan, INFINITY}) {
      c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z)};
      for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = nothing;
      expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 0.5, 0.25, kConstant);
    }
    c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_DEVICE)};
    for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = 1;  // cleared
    expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 0.5, 0.25, kConstant);
  }
}

TEST_F(Replay, NoBackDepthAndNoMapIsNeverBright) {
  Capture c = flatCapture(8, 8);
  c.backDepth = {};
  c.lights = {backLight()};
  expectPixel(replay(c, testMaterial()), 4, 4, 1, 0.5, 0.25, kConstant);
}

// Lights with and without maps, of every type, more than one dispatch binds.
TEST_F(Replay, LightsAddUp) {
  Capture c = flatCapture(8, 8, 2);
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  const double through = 6 * std::exp(-1.0);  // of one light, red
  for (const int mapped : {0, 1, 4, 19}) {
    for (const int lights : {1, 8, 64}) {
      if (mapped > lights) continue;
      c.lights.assign(static_cast<size_t>(lights), backLight());
      for (int i = 0; i < mapped; ++i)
        c.lights[static_cast<size_t>(i)].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z, 4)};
      const Image out = replay(c, testMaterial(), s);
      EXPECT_NEAR(out.at(4, 4)[0], 1 + lights * through, 1e-5 * lights * through)
          << lights << " lights, " << mapped << " maps";
    }
  }
}

TEST_F(Replay, PointAndSpotLightsFollowTheInverseSquare) {
  Capture c = flatCapture(1, 1, 2);
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  light.position = {0, 0, -32};  // 20 mm behind the back face
  light.intensity = 1200;
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  const double red = 2 * std::exp(-1.0) * 1200 / 400;
  c.lights = {light};
  EXPECT_NEAR(replay(c, testMaterial(), s).at(0, 0)[0], 1 + red, 1e-5 * red);
  light.range = 40;
  c.lights = {light};
  EXPECT_NEAR(replay(c, testMaterial(), s).at(0, 0)[0], 1 + red * (1 - 1.0 / 16), 1e-5 * red);
  light.range = 10;
  c.lights = {light};
  EXPECT_NEAR(replay(c, testMaterial(), s).at(0, 0)[0], 1, 1e-6);
  light = c.lights[0];
  light.range = 0;
  light.type = PELLUCID_LIGHT_SPOT;
  light.direction = {0, 0, 1};
  light.innerConeAngle = 0.1;
  light.outerConeAngle = 0.2;
  c.lights = {light};
  EXPECT_NEAR(replay(c, testMaterial(), s).at(0, 0)[0], 1 + red, 1e-5 * red);
  light.direction = {1, 0, 0};
  c.lights = {light};
  EXPECT_NEAR(replay(c, testMaterial(), s).at(0, 0)[0], 1, 1e-6);
}

// Irradiance noise, two objects, a depth step: everything that could make a difference between runs.
Capture busyCapture(int width, int height) {
  Capture c = flatCapture(width, height, 1.5);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(0, 2);
  for (float& v : c.irradiance.data) v = value(random);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (x > width / 2) c.frontDepth.image.at(x, y)[0] = 11;
      if ((x / 7 + y / 5) % 4 == 0) c.material[static_cast<size_t>(y * width + x)] = 0;
    }
  c.lights = {backLight()};
  return c;
}

TEST_F(Replay, SameRunSameBits) {
  const Capture c = busyCapture(61, 47);
  EXPECT_TRUE(sameBits(replay(c, testMaterial()), replay(c, testMaterial())));
}

// The frames that are timed come after the one that is returned, and find its inputs.
TEST_F(Replay, TimedFramesChangeNothing) {
  Capture c = flatCapture(24, 16, 2);
  c.lights = {backLight()};
  ReplaySettings aliased;
  aliased.aliasOutput = true;
  aliased.features = PELLUCID_FEATURE_TRANSLUCENCY;
  for (const ReplaySettings& s : {ReplaySettings{}, aliased}) {
    const ReplayResult once = replayer().run(c, {testMaterial()}, s);
    const ReplayResult timed = replayer().run(c, {testMaterial()}, s, 2);
    EXPECT_TRUE(sameBits(once.output, timed.output));
    EXPECT_TRUE(once.times.empty());
    ASSERT_EQ(timed.times.size(), timed.plan.dispatchCount);
    for (const DispatchTime& time : timed.times) EXPECT_GT(time.microseconds, 0) << time.name;
  }
  const FrameRun frame(device(), replayer().contextFor(c), c, {testMaterial()}, aliased);
  const auto record = [&] {
    device().run([&](VkCommandBuffer commandBuffer) { frame.record(commandBuffer); });
    return frame.output();
  };
  const Image first = record();
  EXPECT_FALSE(sameBits(record(), first)) << "an output in place is the next input";
  frame.restoreIrradiance(c);
  EXPECT_TRUE(sameBits(record(), first));
}

TEST_F(Replay, ContextKeepsWhatTheModuleSays) {
  const Capture capture = flatCapture(8, 8);
  const Context& context = replayer().contextFor(capture);
  const FrameRun run(device(), context, capture, {testMaterial()}, {});
  const PellucidConstantsSlice noBuffer{};
  const auto unused = reinterpret_cast<VkCommandBuffer>(uintptr_t{1});
  EXPECT_EQ(pellucidRecordPlan(context.handle(), unused, &run.plan(), &run.frame(), &noBuffer),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_TRUE(
      context.message().ends_with("constants needs a buffer and an offset that is a multiple of 256"));
}

// A plan knows images by their places in the frame, where another frame may have none.
TEST_F(Replay, FramesWithoutAnImageOfThePlanAreRefused) {
  const Capture capture = flatCapture(8, 8);
  const Context& context = replayer().contextFor(capture);
  const FrameRun run(device(), context, capture, {testMaterial()}, {});
  const auto unused = reinterpret_cast<VkCommandBuffer>(uintptr_t{1});
  const PellucidConstantsSlice constants{reinterpret_cast<VkBuffer>(uintptr_t{1}), 0, 0, nullptr};
  PellucidFrame lacking = run.frame();
  for (PellucidImage& image : lacking.transients) image = {};
  EXPECT_EQ(pellucidRecordPlan(context.handle(), unused, &run.plan(), &lacking, &constants),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(context.message().find("] has no view, but the plan binds it"), std::string::npos)
      << context.message();
  PellucidFrame blind = run.frame();
  blind.output = {};
  EXPECT_EQ(pellucidRecordPlan(context.handle(), unused, &run.plan(), &blind, &constants),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_TRUE(context.message().ends_with("output has no view, but the plan binds it")) << context.message();
}

TEST_F(Replay, OutputMayBeTheIrradianceImage) {
  Capture c = busyCapture(61, 47);
  c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_DEVICE)};
  ReplaySettings s;
  s.translucency.gatherSpacing = 4;
  for (const uint32_t gatherSamples : {0u, 8u})
    for (const uint32_t features : {1u, 2u, 3u}) {
      s.translucency.gatherSamples = gatherSamples;
      s.features = features;
      s.aliasOutput = false;
      const Image apart = replay(c, testMaterial(), s);
      s.aliasOutput = true;
      EXPECT_TRUE(sameBits(apart, replay(c, testMaterial(), s)))
          << "features " << features << ", samples " << gatherSamples;
    }
}

// Not a number, infinity and below 0 here and there in `bad`, where `good` has 0: inside, and at the borders
// of the rects that are tested, in quads that these cut and in others.
void spoilIrradiance(Capture& bad, Capture& good) {
  const float values[] = {kNan, -INFINITY, -1};
  int i = 0;
  const auto spoil = [&](int x, int y, int channel) {
    bad.irradiance.at(x, y)[channel] = values[static_cast<size_t>(i++) % std::size(values)];
    good.irradiance.at(x, y)[channel] = 0;
  };
  for (int y = 3; y < 48; y += 19)
    for (int x = 2; x < 64; x += 17) spoil(x, y, i % 3);
  for (int k = 0; k < 3; ++k)  // a whole quad
    for (const int y : {30, 31})
      for (const int x : {40, 41}) spoil(x, y, k);
  for (int k = 0; k < 3; ++k) {
    spoil(0, 13, k);
    spoil(10 + k, 1, k);
    spoil(62, 30 + k, k);
    spoil(33, 46, k);
  }
}

// One pass reads values that another has looked at.
TEST_F(Replay, DiffusionCountsBadIrradianceAsNone) {
  Capture bad = flatCapture(64, 48), good = bad;
  spoilIrradiance(bad, good);
  ReplaySettings s;
  s.features = PELLUCID_FEATURE_DIFFUSION;
  for (const std::array<uint32_t, 4>& rect : {std::array<uint32_t, 4>{}, {1, 1, 62, 46}}) {
    s.renderRect = rect;
    const Image expected = replay(good, testMaterial(), s), out = replay(bad, testMaterial(), s);
    const int border = rect[0] == 0 ? 0 : 1;
    for (int y = border; y < 48 - border; ++y)
      for (int x = border; x < 64 - border; ++x)
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(out.at(x, y)[k], expected.at(x, y)[k],
                      2e-3 * static_cast<double>(expected.at(x, y)[k]) + 1e-6)
              << x << ", " << y;
  }
}

TEST_F(Replay, PoisonNeverReachesTheOutput) {
  Capture c = busyCapture(64, 48);
  c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_DEVICE)};
  const auto inside = [&](int x, int y) { return x >= 10 && x < 47 && y >= 7 && y < 36; };
  Capture poisoned = c;
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      if (inside(x, y) && c.material[static_cast<size_t>(y * c.width + x)] != 0) continue;
      for (int k = 0; k < 3; ++k) poisoned.irradiance.at(x, y)[k] = poisoned.normal.at(x, y)[k] = kNan;
      poisoned.frontDepth.image.at(x, y)[0] = poisoned.backDepth.image.at(x, y)[0] = kNan;
    }
  for (const uint32_t samples : {0u, 8u}) {
    ReplaySettings s;
    s.renderRect = {10, 7, 37, 29};
    s.translucency.gatherSamples = samples;
    const Image clean = replay(c, testMaterial(), s), out = replay(poisoned, testMaterial(), s);
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        const bool owned = inside(x, y) && c.material[static_cast<size_t>(y * c.width + x)] != 0;
        for (int k = 0; k < 3; ++k) {
          if (owned)
            EXPECT_EQ(out.at(x, y)[k], clean.at(x, y)[k]) << x << ", " << y << ", samples " << samples;
          else
            EXPECT_TRUE(std::isnan(out.at(x, y)[k])) << "written at " << x << ", " << y;
        }
      }
  }
}

TEST_F(Replay, BadValuesAtMaterialPixelsStayFinite) {
  Capture c = busyCapture(32, 32);
  c.lights.push_back(backLight());
  c.lights[1].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z)};
  const float bad[] = {kNan, INFINITY, -INFINITY, -1, 0, 1e38f, 1e-38f};
  int i = 0;
  const auto next = [&] { return bad[static_cast<size_t>(i++) % std::size(bad)]; };
  for (int y = 0; y < 32; y += 3)
    for (int x = 0; x < 32; x += 2) {
      c.irradiance.at(x, y)[y % 3] = next();
      c.frontDepth.image.at(x, y)[0] = next();
      c.backDepth.image.at(31 - x, y)[0] = next();
      c.normal.at(x, 31 - y)[x % 3] = next();
      c.lights[1].shadowMaps[0].depth.image.at(x, y)[0] = next();
    }
  ReplaySettings s;
  for (const auto source : {0, 1})
    for (const uint32_t samples : {0u, 8u}) {
      s.translucency.cameraThickness = source;
      s.translucency.gatherSamples = samples;
      const Image out = replay(c, testMaterial(), s);
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
          for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(c.material[static_cast<size_t>(y * 32 + x)] == 0 ||
                        (std::isfinite(out.at(x, y)[k]) && out.at(x, y)[k] >= 0))
                << x << ", " << y << ", samples " << samples;
    }
}

// PEERS.md defect 1: dark skin beside lit skin must not count as "not skin".
TEST_F(Replay, BlackIsNotAMask) {
  const auto edge = [](float dark) {
    Capture c = flatCapture(64, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 32; ++x)
        for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = dark;
    return c;
  };
  const Image black = replay(edge(0), testMaterial()), almost = replay(edge(1e-6f), testMaterial());
  for (int x = 0; x < 64; ++x) EXPECT_NEAR(black.at(x, 4)[0], almost.at(x, 4)[0], 1e-3) << x;
  EXPECT_GT(black.at(31, 4)[0], 0.2f) << "light diffuses into the dark";
}

// Two sheets with a gap in depth of 8 mm: Gaussians of at most 4.5 mm^2 let e^{-64/9} across, wherever the
// gap lies against the pyramid.
TEST_F(Replay, DepthGapStopsDiffusion) {
  for (int first = 28; first <= 36; ++first) {
    Capture c = flatCapture(64, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = first; x < 64; ++x) {
        c.frontDepth.image.at(x, y)[0] = 18;
        for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = 0;
      }
    const Image out = replay(c, testMaterial());
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(out.at(first, 4)[k], std::exp(-64.0 / 9) * c.irradiance.at(0, 0)[k])
          << first << ", channel " << k;
  }
}

TEST_F(Replay, MaterialBorderStopsDiffusion) {
  Capture c = flatCapture(32, 8);
  c.materials.resize(2);
  for (int y = 0; y < 8; ++y)
    for (int x = 16; x < 32; ++x) {
      c.material[static_cast<size_t>(y * 32 + x)] = 2;
      for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = 0;
    }
  const Image out = replayer().run(c, {testMaterial(), testMaterial()}, {}).output;
  expectPixel(out, 15, 4, 1, 0.5, 0.25, kConstant);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(16, 4)[k], 0);
}

TEST_F(Replay, MaterialBeyondTheListIsNone) {
  Capture c = flatCapture(4, 4);
  c.material[5] = 9;
  Capture poison = c;
  for (int k = 0; k < 3; ++k) poison.irradiance.at(1, 1)[k] = 100;
  expectPixel(replay(poison, testMaterial()), 2, 2, 1, 0.5, 0.25, kConstant);
  EXPECT_EQ(replay(poison, testMaterial()).at(1, 1)[0], 100) << "not written";
}

TEST_F(Replay, AlbedoMultipliesOnceAtTheEnd) {
  Capture c = flatCapture(16, 16, 2);
  c.albedo = Image(16, 16, 3, 0.5f);
  c.lights = {backLight()};
  for (const uint32_t features : {1u, 3u}) {
    ReplaySettings s;
    s.features = features;
    const Image out = replay(c, testMaterial(), s);
    expectPixel(out, 8, 8, 0.5 * (1 + 6 * std::exp(-1.0)), 0.5 * (0.5 + 6 * std::exp(-2.0)),
                0.5 * (0.25 + 6 * (0.7 * std::exp(-4.0) + 0.3 * std::exp(-0.5))), kConstant);
  }
}

// Whatever matrix rendered the depths, the picture is the same.
TEST_F(Replay, EveryDepthConventionGivesTheSamePicture) {
  const double n = 1, f = 100;
  struct Convention {
    const char* name;
    double a, b, c, d, s;
  };
  const Convention conventions[] = {
      {"perspective RH", -f / (f - n), -f * n / (f - n), -1, 0, -1},
      {"perspective RH reversed", n / (f - n), f * n / (f - n), -1, 0, -1},
      {"perspective RH reversed infinite", 0, n, -1, 0, -1},
      {"perspective LH", f / (f - n), -f * n / (f - n), 1, 0, 1},
  };
  ReplaySettings s = inFloats();
  Image first;
  for (const Convention& v : conventions) {
    Capture c = flatCapture(32, 32, 2);
    c.clipFromView = {4, 0, 0, 0, 0, -4, 0, 0, 0, 0, v.a, v.c, 0, 0, v.b, v.d};
    for (DepthImage* depth : {&c.frontDepth, &c.backDepth}) {
      depth->encoding = PELLUCID_DEPTH_DEVICE;
      for (float& p : depth->image.data)
        p = static_cast<float>((v.a * v.s * p + v.b) / (v.c * v.s * p + v.d));
    }
    for (size_t i = 0; i < c.normal.pixels(); ++i) c.normal.data[3 * i + 2] = static_cast<float>(-v.s);
    Light light = backLight();
    light.direction = {0, 0, -v.s};  // towards the eye
    c.lights = {light};
    const Image out = replay(c, testMaterial(), s);
    if (first.empty()) first = out;
    // 1e-4: forward-Z float depth at 10 of [1, 100] mm resolves 6e-6 of a 2 mm thickness.
    for (size_t i = 0; i < out.data.size(); ++i)
      ASSERT_NEAR(out.data[i], first.data[i], 1e-4 * first.data[i]) << v.name;
  }
}

TEST_F(Replay, DebugViews) {
  Capture c = flatCapture(8, 8, 2);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z)};
  ReplaySettings s = inFloats();
  s.debugView = PELLUCID_DEBUG_TRANSMITTANCE;
  expectPixel(replay(c, testMaterial(), s), 4, 4, std::exp(-1.0), std::exp(-2.0),
              0.7 * std::exp(-4.0) + 0.3 * std::exp(-0.5), 1e-5);
  s.debugView = PELLUCID_DEBUG_OCCLUSION;
  expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 1, 1, 1e-6);
  s.debugView = PELLUCID_DEBUG_IRRADIANCE;
  EXPECT_NEAR(replay(c, testMaterial(), s).at(4, 4)[0], 1 + 6 * std::exp(-1.0), 1e-4);
  c.material[0] = 0;
  EXPECT_EQ(replay(c, testMaterial(), s).at(0, 0)[0], 0) << "material 0 stays cleared";
}

TEST_F(Replay, TransmittanceModelsMatchTheirFormulas) {
  PellucidMaterial sinh = testMaterial(), gauss = testMaterial();
  sinh.transmittanceModel = PELLUCID_TRANSMITTANCE_SINH_EXP;
  const float parameters[3][5] = {
      {0.5f, 0.3f, 0.8f, 0.1f, 2}, {1e-4f, 1e-4f, 2e-4f, 0.2f, 1}, {0.4f, 3, 1, 0.3f, 0.5f}};
  std::memcpy(sinh.transmittance, parameters, sizeof parameters);
  gauss.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
  ReplaySettings s = inFloats();
  s.debugView = PELLUCID_DEBUG_TRANSMITTANCE;
  for (const double d : {0.01, 0.5, 3.0, 12.0}) {
    Capture c = flatCapture(1, 1, d);
    c.lights = {backLight()};
    // The stored depths are floats: the thickness has their rounding.
    const double t =
        static_cast<double>(c.backDepth.image.data[0]) - static_cast<double>(c.frontDepth.image.data[0]);
    const Image s1 = replay(c, sinh, s), g1 = replay(c, gauss, s);
    for (int k = 0; k < 3; ++k) {
      const auto p = [&](int i) { return static_cast<double>(parameters[k][i]); };
      const double expected = p(0) / std::sinh(p(1) * t + p(2)) + p(3) * std::exp(-p(4) * t);
      EXPECT_NEAR(s1.data[static_cast<size_t>(k)], expected, 1e-5 * expected + 1e-9)
          << "d " << d << " channel " << k;
      double sum = 0;
      for (uint32_t i = 0; i < 2; ++i)
        sum += static_cast<double>(gauss.gaussianWeight[k][i]) *
               std::exp(-t * t / (2 * static_cast<double>(gauss.gaussianVariance[k][i])));
      EXPECT_NEAR(g1.data[static_cast<size_t>(k)], sum, 1e-5 * sum + 1e-9) << "d " << d << " channel " << k;
    }
  }
}

}  // namespace
