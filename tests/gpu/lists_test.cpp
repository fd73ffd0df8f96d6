// Lists of blocks change where passes run and no pixel.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "gpu_fixture.h"

namespace {

using namespace pellucid::test;

using Lists = GpuTest;

// Islands of material, some of one pixel, on a plane that is lit from behind; most of the image is empty.
Capture islands(int width, int height, unsigned seed) {
  Capture c = flatCapture(width, height);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z, 256)};
  std::mt19937 random(seed);
  const auto below = [&](int end) { return std::uniform_int_distribution<int>(0, end - 1)(random); };
  c.material.assign(c.material.size(), 0);
  for (int i = 0; i < 5; ++i) {
    const int side = i < 2 ? 1 : 1 + below(40), x0 = below(width), y0 = below(height);
    for (int y = y0; y < std::min(y0 + side, height); ++y)
      for (int x = x0; x < std::min(x0 + side, width); ++x)
        c.material[static_cast<size_t>(y * width + x)] = 1;
  }
  for (float& value : c.irradiance.data) value = static_cast<float>(below(1000)) / 1000;
  return c;
}

// Device depths of the capture's camera in place of planar distances.
Capture withDeviceDepth(Capture c) {
  c.frontDepth.encoding = PELLUCID_DEPTH_DEVICE;
  const Matrix& m = c.clipFromView;  // view z is negative in front of the eye
  for (float& depth : c.frontDepth.image.data) {
    const double z = -static_cast<double>(depth);
    depth = static_cast<float>((m[10] * z + m[14]) / (m[11] * z + m[15]));
  }
  return c;
}

Capture inPerspective(Capture c) {
  const Capture other = perspectiveCapture(std::max(c.width, c.height));
  c.clipFromView = other.clipFromView;
  return c;
}

struct Way {
  const char* name;
  void (*change)(ReplaySettings&);
};

constexpr Way kWays[] = {
    {"one thickness", [](ReplaySettings& s) { s.translucency.gatherSamples = 0; }},
    {"cells of 4 pixels", [](ReplaySettings& s) { s.translucency.gatherSpacing = 4; }},
    {"a rect from odd pixels",
     [](ReplaySettings& s) {
       s.renderRect = {67, 33, 81, 70};
     }},
    // Indices with noise around them.
    {"a material mask",
     [](ReplaySettings& s) {
       s.materialShift = 4;
       s.materialMask = 0xFF0;
     }},
};

// The transients hold NaN before each recording, so that a texel that no group wrote shows.
TEST_F(Lists, ChangeNoPixel) {
  for (const unsigned seed : {1u, 2u})
    for (const Way& way : kWays) {
      Capture c = islands(180 + 3 * static_cast<int>(seed), 130, seed);
      if (seed == 2) c = withDeviceDepth(inPerspective(std::move(c)));
      ReplaySettings s;
      s.translucency.gatherSamples = 8;
      way.change(s);
      s.indirectDispatches = 0;
      const Image whole = replay(c, testMaterial(), s);
      s.indirectDispatches = 1;
      const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
      EXPECT_TRUE(sameBits(record(run), whole)) << way.name << ", seed " << seed;
      if (seed > 1) continue;
      EXPECT_TRUE(sameBits(record(run), whole)) << way.name << ", a recording may run more than once";
    }
}

TEST_F(Lists, GroupsFollowTheMaterial) {
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  Capture c = islands(256, 256, 1);
  // How many groups of each dispatch ran.
  const auto groups = [&] {
    const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
    record(run);
    const Statistics statistics = run.statistics();
    EXPECT_EQ(statistics.lists, s.indirectDispatches);
    std::map<std::string, Groups> found;
    for (uint32_t i = run.plan().dispatchCount; i-- > 0;)
      found[run.plan().dispatches[i].name] = statistics.dispatches[i];
    return found;
  };
  constexpr const char* kListed[] = {"downsample",   "coarse levels", "upsample",     "diffuse",
                                     "entry points", "probes",        "filter probes"};
  c.material.assign(c.material.size(), 0);
  auto found = groups();
  for (const char* name : kListed) EXPECT_EQ(found.at(name).run, 0u) << name << " of nothing";
  c.material[128 * 256 + 128] = 1;  // the first pixel of one of 16 blocks
  found = groups();
  // The pyramid's border touches one more block on each side.
  for (const auto& [name, blocks, most] :
       {std::tuple("downsample", 9u, 36u), {"upsample", 9u, 36u}, {"diffuse", 1u, 16u}})
    EXPECT_EQ(most * found[name].run, blocks * found[name].most) << name;
  // 2 reaches of 2 mm around a pixel are 8 of 256 texels of the map's 200 mm, and groups have 16 entry
  // points.
  EXPECT_GT(found["entry points"].run, 0u);
  EXPECT_LT(found["entry points"].run, 64u);
  s.indirectDispatches = 0;
  found = groups();
  for (const char* name : kListed) EXPECT_EQ(found.at(name).run, found.at(name).most) << name;
}

// A sheet 1 mm deep that recedes from 14 to 55 cm, lit from behind. Cells of 4 pixels grow from 2 to 9 mm, and entry points of level 0
// shrink from 1.8 to .2 mm: probes read all levels.
Capture recedingSheet() {
  constexpr int kWidth = 64, kHeight = 256, kMap = 512;
  constexpr double kLight = -60, kSlope = 1.2;
  Capture c = flatCapture(kWidth, kHeight);
  c.metersPerUnit = 0.01;
  c.clipFromView = perspectiveCapture(kHeight).clipFromView;
  c.clipFromView[0] = 8;
  c.clipFromView[5] = -2;
  // Depths of a plane z = -(distance + slope y): a view ray of a pixel has y = z times the tangent of its angle.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double tangent = 0.5 - (y + 0.5) / kHeight;
      c.frontDepth.image.at(x, y)[0] = static_cast<float>(22 / (1 - kSlope * tangent));
    }
  c.backDepth = {};
  Light light = backLight();
  light.type = PELLUCID_LIGHT_SPOT;
  light.position = {0, 0, kLight};
  light.intensity = 3000;
  ShadowMap map;
  map.clipFromWorld = {};
  map.clipFromWorld[0] = map.clipFromWorld[5] = map.clipFromWorld[10] = map.clipFromWorld[11] = 1;
  map.clipFromWorld[14] = -kLight - 1;
  map.clipFromWorld[15] = -kLight;
  map.depth.encoding = PELLUCID_DEPTH_DEVICE;
  map.depth.image = Image(kMap, kMap, 1);
  for (int y = 0; y < kMap; ++y)
    for (int x = 0; x < kMap; ++x) {
      const double tangent = 2 * (y + 0.5) / kMap - 1;
      const double along = (-kLight - 22.1) / std::max(1 + kSlope * tangent, 0.1);
      map.depth.image.at(x, y)[0] = static_cast<float>(1 - 1 / along);
    }
  light.shadowMaps = {map};
  c.lights = {light};
  return c;
}

// Probes of one frame read several levels of a map, and all that they read is listed.
TEST_F(Lists, HoldTheLevelsThatProbesRead) {
  const Capture c = recedingSheet();
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  s.translucency.gatherSpacing = 4;
  s.indirectDispatches = 0;
  const Image whole = replay(c, testMaterial(), s);
  for (const int y : {40, 128, 250}) EXPECT_GT(whole.at(32, y)[0], 1.3f) << "light comes through, " << y;
  s.indirectDispatches = 1;
  const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
  EXPECT_TRUE(sameBits(record(run), whole));
  EXPECT_LT(run.statistics().entryPoints.run, run.statistics().entryPoints.most);
}

// A cell of 8 mm reads entry points of 1.6 mm, level 2, and one of 2 mm those of .4 mm.
TEST_F(Lists, SmallFramesNeedFewEntryPoints) {
  Capture c = flatCapture(96, 96);
  c.clipFromView[0] = 1.0 / 96;
  c.clipFromView[5] = -1.0 / 96;
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z, 1024)};
  const auto groups = [&](uint32_t spacing) {
    ReplaySettings s;
    s.translucency.gatherSamples = 8;
    s.translucency.gatherSpacing = spacing;
    const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
    record(run);
    return run.statistics().entryPoints.run;
  };
  const uint64_t fine = groups(1), coarse = groups(4);
  EXPECT_GT(fine, 900u);
  EXPECT_EQ(fine, 16 * coarse) << coarse;
}

// Material at random: the statistics and a look at each pixel agree.
TEST_F(Lists, StatisticsAreThoseOfTheMaterial) {
  constexpr int kSide = 256, kBlock = 64;
  for (const bool rect : {false, true}) {
    Capture c = islands(kSide, kSide, 2);
    c.lights.push_back(c.lights[0]);
    ReplaySettings settings;
    settings.translucency.gatherSamples = 8;
    if (rect) settings.renderRect = {35, 21, 180, 171};
    const FrameRun frame(device(), replayer().contextFor(c), c, {testMaterial()}, settings);
    record(frame);
    const Statistics s = frame.statistics();
    const int left = rect ? 35 : 0, top = rect ? 21 : 0, right = rect ? 215 : kSide, bottom = rect ? 192 : kSide;
    std::set<std::pair<int, int>> blocks, withMaterial;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        blocks.insert({x / kBlock, y / kBlock});
        if (c.material[static_cast<size_t>(y * kSide + x)] != 0) withMaterial.insert({x / kBlock, y / kBlock});
      }
    EXPECT_GT(withMaterial.size(), 1u);
    EXPECT_EQ(s.blocks.run, withMaterial.size()) << "a block is listed twice";
    EXPECT_EQ(s.blocks.most, blocks.size());
    EXPECT_GT(s.entryPoints.run, 0u);
    EXPECT_EQ(s.entryPoints.run % 2, 0u) << "two maps that are alike";
  }
}

}  // namespace
