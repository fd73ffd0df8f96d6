// The promises about pixels: what is read, what is written, and that it is always the same.
#include "gpu_fixture.h"

#include <cmath>
#include <limits>

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
                                         std::pair(121, 17), std::pair(244, 150)));

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

// A slab's thickness tells all that its back depths tell: light of a hidden face, shadowed or not, light from all around, and what thin
// bodies return.
TEST_F(Replay, StoredThicknessIsThatOfASlab) {
  for (Capture depths : {flatCapture(24, 24, 2), perspectiveCapture(24)}) {
    depths.lights = {backLight(), backLight(), backLight()};
    depths.lights[0].direction = {0.6, 0, 0.8};
    depths.lights[1].shadowMaps = {flatShadowMap(-9.5, PELLUCID_DEPTH_VIEW_Z)};
    depths.lights[1].shadowMaps[0].backFaces = true;
    depths.lights[2].shadowMaps = {flatShadowMap(-11.5, PELLUCID_DEPTH_VIEW_Z)};
    depths.environment = Harmonics{{{1, 0.5, 0.25}}};
    depths.materials = {PresetMaterial{"skin1"}};
    Capture stored = depths, unknown = depths, none = depths;
    const float mm = depths.backDepth.image.data[0] - 10;
    stored.backDepth = {Image(24, 24, 1, mm), PELLUCID_DEPTH_THICKNESS};
    unknown.backDepth = {Image(24, 24, 1, -1), PELLUCID_DEPTH_THICKNESS};
    none.backDepth = {};
    for (const uint32_t samples : {0u, 8u}) {
      ReplaySettings s = gathering(samples);
      s.ambient = true;
      const Image expected = replay(depths, s), image = replay(stored, s), dark = replay(unknown, s);
      EXPECT_LT(relativeRmse(image, expected), 1e-4) << samples;
      EXPECT_GT(image.at(12, 12)[0], 1.2f * dark.at(12, 12)[0]) << samples;
      if (samples > 0) continue;  // the first of a gather's lights is not the first of a plan
      EXPECT_LT(relativeRmse(dark, replay(none, s)), 1e-6) << "a thickness that is not known lets no light through";
    }
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
    for (const float nothing : {0.0f, kNan, INFINITY}) {
      c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z)};
      for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = nothing;
      expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 0.5, 0.25, kConstant);
    }
    c.lights[0].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_DEVICE)};
    for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = 1;  // cleared
    expectPixel(replay(c, testMaterial(), s), 4, 4, 1, 0.5, 0.25, kConstant);
  }
}

// A half that overflowed lights nothing: its pixel and all around have the bits of one that is NaN.
TEST_F(Replay, InfinityInInputsCountsAsNaNDoes) {
  Capture c = flatCapture(64, 64, 2);
  c.albedo = Image(64, 64, 3, 0.5f);
  c.hiddenIrradiance = Image(64, 64, 3, 1.0f);
  for (const uint32_t format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT})
    for (Image Capture::*image : {&Capture::irradiance, &Capture::albedo, &Capture::hiddenIrradiance}) {
      ReplaySettings s = inFloats();
      s.irradianceFormat = static_cast<VkFormat>(format);
      const auto with = [&](float value) {
        Capture bad = c;
        (bad.*image).at(30, 33)[0] = value;
        return replay(bad, testMaterial(), s);
      };
      const Image expected = with(kNan);
      for (const float value : {INFINITY, -INFINITY, 0.0f}) EXPECT_TRUE(sameBits(with(value), expected)) << value;
      // Nothing but light of the pixel itself is missing.
      EXPECT_LE(expected.at(34, 33)[0], replay(c, testMaterial(), s).at(34, 33)[0]);
    }
}

// Light brighter than a half holds is still light, as a half or as a float.
TEST_F(Replay, IrradianceBeyondHalvesIsTheLargestHalf) {
  Capture c = flatCapture(16, 16), brightest = c;
  for (float& v : c.irradiance.data) v = 3e8f;
  for (float& v : brightest.irradiance.data) v = 65504;
  for (const uint32_t format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
    ReplaySettings s = inFloats();
    s.irradianceFormat = static_cast<VkFormat>(format);
    const Image out = replay(c, testMaterial(), s);
    EXPECT_TRUE(sameBits(out, replay(brightest, testMaterial(), s)));
    EXPECT_GT(out.at(8, 8)[0], 65000);
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
  for (const auto& [lights, mapped] : {std::pair(1, 0), {1, 1}, {8, 4}, {64, 19}}) {
    c.lights.assign(static_cast<size_t>(lights), backLight());
    for (int i = 0; i < mapped; ++i)
      c.lights[static_cast<size_t>(i)].shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z, 4)};
    const Image out = replay(c, testMaterial(), s);
    EXPECT_NEAR(out.at(4, 4)[0], 1 + lights * through, 1e-5 * lights * through)
        << lights << " lights, " << mapped << " maps";
  }
}

TEST_F(Replay, PointAndSpotLightsFollowTheInverseSquare) {
  Capture c = flatCapture(1, 1, 2);
  Light point;
  point.type = PELLUCID_LIGHT_POINT;
  point.position = {0, 0, -32};  // 20 mm behind the back face
  point.intensity = 1200;
  Light spot = point;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.direction = {0, 0, 1};
  spot.innerConeAngle = 0.1;
  spot.outerConeAngle = 0.2;
  Light near = point, nearer = point, aside = spot;
  near.range = 40;
  nearer.range = 10;
  aside.direction = {1, 0, 0};
  const double red = 2 * std::exp(-1.0) * 1200 / 400;
  for (const auto& [light, part] : {std::pair(point, 1.0), {near, 1 - 1.0 / 16}, {nearer, 0.0}, {spot, 1.0}, {aside, 0.0}}) {
    c.lights = {light};
    EXPECT_NEAR(replay(c, testMaterial(), inFloats(PELLUCID_FEATURE_TRANSLUCENCY)).at(0, 0)[0], 1 + red * part, 1e-5 * red);
  }
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
  const Image first = record(frame);
  EXPECT_FALSE(sameBits(record(frame), first)) << "an output in place is the next input";
  frame.restoreIrradiance(c);
  EXPECT_TRUE(sameBits(record(frame), first));
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

TEST_F(Replay, DebugViewOfTheIrradiance) {
  Capture c = flatCapture(8, 8, 2);
  c.lights = {backLight()};
  c.material[0] = 0;
  ReplaySettings s = inFloats();
  s.debugView = PELLUCID_DEBUG_IRRADIANCE;
  const Image out = replay(c, testMaterial(), s);
  EXPECT_NEAR(out.at(4, 4)[0], 1 + 6 * std::exp(-1.0), 1e-4);
  EXPECT_EQ(out.at(0, 0)[0], 0) << "material 0 stays cleared";
}

// Depths that are none, at pixels that have a material: there is nothing, in every encoding and pass.
TEST_F(Replay, DepthsThatAreNoneAreNothingThere) {
  for (const bool device : {true, false}) {
    Capture c = perspectiveCapture(80);
    for (size_t i = 0; i < c.irradiance.data.size(); ++i) c.irradiance.data[i] = 0.1f * static_cast<float>(i % 17);
    c.lights = {backLight()};
    c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z)};
    if (device) {
      // Reversed and infinite: .1 / planar distance.
      c.frontDepth.encoding = PELLUCID_DEPTH_DEVICE;
      for (float& depth : c.frontDepth.image.data) depth = 0.1f / depth;
    }
    for (const uint32_t samples : {0u, 8u}) {
      ReplaySettings s;
      s.translucency.gatherSamples = samples;
      const auto at = [&](float depth) {
        for (const auto& [x, y] : {std::pair(40, 41), std::pair(55, 70), std::pair(56, 70)})
          c.frontDepth.image.at(x, y)[0] = depth;
        return replay(c, testMaterial(), s);
      };
      const Image expected = at(device ? 0.0f : -1.0f);
      for (const float v : expected.data) ASSERT_TRUE(std::isfinite(v) && v >= 0);
      // The smallest depths are nearer to 0 than any distance is far.
      for (const float depth : {-INFINITY, kNan, device ? 1e-40f : 2e9f})
        EXPECT_TRUE(sameBits(at(depth), expected)) << depth << ", device " << device << ", samples " << samples;
    }
  }
}

// A light that turns: frames that refresh are as without reuse, frames between them are their own irradiance
// plus the light that came through at the last refresh.
TEST_F(Replay, ReuseOverATurningLight) {
  constexpr int kFrames = 6;
  // One fused dispatch, and two.
  for (const auto& [reuse, maps] : {std::pair(PELLUCID_REUSE_ALTERNATE, 9), {PELLUCID_REUSE_COHERENCE, 1}}) {
    ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
    s.reuse = reuse;
    ReplaySettings plain = s;
    plain.reuse = PELLUCID_REUSE_NONE;
    Sequence sequence;
    constexpr float kAlbedo = 0.5f;  // of the last dispatch; a division by it has no rounding
    const auto withoutAlbedo = [](Image image) {
      for (float& v : image.data) v /= kAlbedo;
      return image;
    };
    Image kept, keptIrradiance;  // of the last refresh
    int refreshed = 0;
    for (int i = 0; i < kFrames; ++i) {
      Capture c = flatCapture(24, 16, 2);
      for (size_t p = 0; p < c.irradiance.data.size(); ++p)
        c.irradiance.data[p] += 0.1f * static_cast<float>(i);
      // Pixels outside of the material at a refresh may have the material later, and may have had it before.
      constexpr int kWidths[kFrames] = {14, 15, 10, 12, 9, 11};
      for (size_t p = 0; p < c.material.size(); ++p) c.material[p] = static_cast<int>(p % 24) < kWidths[i];
      const double angle = 0.2 + 0.02 * i;
      for (int k = 0; k < maps; ++k) {
        Light light = backLight();
        light.direction = {std::sin(angle), 0, std::cos(angle)};
        light.intensity = 1;
        light.shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z, 4)};
        Matrix& clip = light.shadowMaps[0].clipFromWorld;
        clip[8] = -clip[0] * std::tan(angle);  // sheared along the light
        c.lights.push_back(light);
      }
      c.albedo = Image(c.width, c.height, 3, kAlbedo);
      const Image out = withoutAlbedo(sequence.run(c, testMaterial(), s)),
                  own = withoutAlbedo(replay(c, testMaterial(), plain));
      if (sequence.last->plan().historyAge == 0) {
        kept = own;
        keptIrradiance = c.irradiance;
        ++refreshed;
      }
      for (size_t p = 0; p < out.data.size(); ++p) {
        const size_t e = p / 4 * 3 + p % 4;
        if (p % 4 == 3 || c.material[p / 4] == 0) continue;
        const bool seen = kept.data[p] != keptIrradiance.data[e];  // was material at the refresh
        const float through = seen ? kept.data[p] - keptIrradiance.data[e] : 0;
        ASSERT_NEAR(out.data[p], c.irradiance.data[e] + through, 1e-5) << "frame " << i;
      }
    }
    EXPECT_GT(refreshed, 1);
    EXPECT_LT(refreshed, kFrames);
    EXPECT_TRUE(reuse != PELLUCID_REUSE_ALTERNATE || refreshed == kFrames / 2) << refreshed;
  }
}

}  // namespace
