// Tile lists change where passes run and no pixel.
#include "gpu_fixture.h"

#include <cstdio>
#include <random>

namespace {

using namespace pellucid::test;

using TileLists = GpuTest;

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

uint64_t groupsOf(const FrameRun& run, const char* name) {
  const PellucidStatistics statistics = run.statistics();
  for (uint32_t i = 0; i < statistics.dispatchCount; ++i)
    if (run.plan().dispatches[i].name == std::string(name)) return statistics.dispatches[i].run;
  return 0;
}

struct Way {
  const char* name;
  void (*change)(ReplaySettings&);
};

constexpr Way kWays[] = {
    {"quality 0",
     [](ReplaySettings& s) {
       s.quality = 0;
       s.translucency.gatherSamples = 0;
     }},
    {"quality 1", [](ReplaySettings&) {}},
    {"cells of 4 pixels", [](ReplaySettings& s) { s.translucency.gatherSpacing = 4; }},
    {"cells of 2 pixels, quality 2",
     [](ReplaySettings& s) {
       s.quality = 2;
       s.translucency.gatherSpacing = 2;
     }},
    {"a rect from odd pixels",
     [](ReplaySettings& s) {
       s.renderRect = {67, 33, 131, 90};
     }},
    {"32 bits", [](ReplaySettings& s) { s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT; }},
};

// The transients hold NaN before each recording, so that a texel that no group wrote shows.
TEST_F(TileLists, ChangeNoPixel) {
  const Context context(device());
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (const Way& way : kWays) {
      const Capture c = islands(260 + 3 * static_cast<int>(seed), 190, seed);
      ReplaySettings s;
      s.translucency.gatherSamples = 8;
      way.change(s);
      s.indirectDispatches = PELLUCID_INDIRECT_NONE;
      const Image whole = replayer().run(c, {testMaterial()}, s).output;
      s.indirectDispatches = PELLUCID_INDIRECT_MATERIAL;
      const FrameRun run(device(), context, c, {testMaterial()}, s);
      // A recording may run more than once.
      for (int times = 0; times < 2; ++times) {
        device().run([&](VkCommandBuffer commands) { run.record(commands); });
        EXPECT_TRUE(sameBits(run.output(), whole)) << way.name << ", seed " << seed << ", run " << times;
      }
    }
}

// 256 x 256 groups of probes are more than fit in a row: their list has two rows of groups in one.
TEST_F(TileLists, HoldRowsOfGroupsInLargeImages) {
  const Capture c = islands(2048, 2048, 5);
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  s.translucency.gatherSpacing = 1;
  s.indirectDispatches = PELLUCID_INDIRECT_NONE;
  const Image whole = replayer().run(c, {testMaterial()}, s).output;
  s.indirectDispatches = PELLUCID_INDIRECT_MATERIAL;
  const ReplayResult listed = replayer().run(c, {testMaterial()}, s);
  EXPECT_TRUE(sameBits(listed.output, whole));
  uint32_t probes = 0;
  for (uint32_t i = 0; i < listed.plan.dispatchCount; ++i)
    if (listed.plan.dispatches[i].name == std::string("probes")) {
      ++probes;
      EXPECT_EQ(listed.plan.dispatches[i].groups[0], 256u * 128u);
      EXPECT_EQ(listed.plan.dispatches[i].groups[1], 2u);
      EXPECT_GT(listed.statistics.dispatches[i].run, 0u);
      EXPECT_LT(listed.statistics.dispatches[i].run, 1000u);
    }
  EXPECT_EQ(probes, 1u);
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

constexpr CellWords kWords[] = {CellWords::Found, CellWords::More, CellWords::All};

// Cells that an engine finds lead to the same bits as those that the module finds, and so do more cells than
// have material.
TEST_F(TileLists, CellsOfTheEngineChangeNoPixel) {
  unsigned seed = 10;
  for (const Way& way : kWays) {
    ++seed;
    Capture c = islands(190 + static_cast<int>(seed), 124, seed);
    if (seed % 2 == 0) c = inPerspective(std::move(c));
    if (seed % 3 != 0) c = withDeviceDepth(std::move(c));
    ReplaySettings s;
    s.translucency.gatherSamples = 8;
    // Indices with noise around them, and a mark.
    s.materialShift = seed % 2 * 4;
    s.materialMask = seed % 2 * 0xFF0;
    s.translucency.materialMarkBit = seed % 4 == 0 ? 128 : 0;
    way.change(s);
    s.indirectDispatches = PELLUCID_INDIRECT_NONE;
    const Image whole = replayer().run(c, {testMaterial()}, s).output;
    s.indirectDispatches = PELLUCID_INDIRECT_MATERIAL;
    EXPECT_TRUE(sameBits(replayer().run(c, {testMaterial()}, s).output, whole)) << way.name;
    s.indirectDispatches = PELLUCID_INDIRECT_CELLS;
    for (const CellWords words : kWords) {
      s.cells = words;
      const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
      // Each recording writes the constants, which empties the lists.
      for (int times = 0; times < (words == CellWords::Found ? 2 : 1); ++times) {
        device().run([&](VkCommandBuffer commands) { run.record(commands); });
        EXPECT_TRUE(sameBits(run.output(), whole))
            << way.name << ", words " << static_cast<int>(words) << ", run " << times;
      }
    }
  }
}

TEST_F(TileLists, CellsOfTheEngineListTheGroups) {
  const Capture c = islands(256, 256, 1);
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  const auto statistics = [&] { return replayer().run(c, {testMaterial()}, s).statistics; };
  const PellucidStatistics found = statistics();
  s.indirectDispatches = PELLUCID_INDIRECT_CELLS;
  const PellucidStatistics same = statistics();
  EXPECT_EQ(same.tileLists, 1u);
  EXPECT_EQ(same.tiles.run, found.tiles.run);
  EXPECT_EQ(same.diffusion.run, found.diffusion.run);
  EXPECT_EQ(same.probes.run, found.probes.run);
  EXPECT_LT(same.tiles.run, same.tiles.most);
  EXPECT_GE(same.entryPoints.run, found.entryPoints.run);  // of distances that may be a bit farther apart
  EXPECT_LT(same.entryPoints.run, same.entryPoints.most);
  s.cells = CellWords::More;
  const PellucidStatistics more = statistics();
  EXPECT_GT(more.tiles.run, same.tiles.run);
  EXPECT_LT(more.tiles.run, more.tiles.most);
  s.cells = CellWords::All;
  const PellucidStatistics all = statistics();
  EXPECT_EQ(all.tiles.run, all.tiles.most);
  EXPECT_EQ(all.probes.run, all.probes.most);
}

TEST_F(TileLists, GroupsFollowTheMaterial) {
  const Context context(device());
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  s.translucency.gatherSpacing = 4;
  Capture c = islands(256, 256, 1);
  const auto groups = [&](const char* name) {
    const FrameRun run(device(), context, c, {testMaterial()}, s);
    device().run([&](VkCommandBuffer commands) { run.record(commands); });
    return groupsOf(run, name);
  };
  c.material.assign(c.material.size(), 0);
  for (const char* name : {"base level", "downsample", "upsample", "diffuse", "diffuse, none gathered",
                           "entry points", "probes"})
    EXPECT_EQ(groups(name), 0u) << name << " of nothing";
  c.material[128 * 256 + 128] = 1;  // the first pixel of a tile
  EXPECT_EQ(groups("base level"), 1u);
  EXPECT_EQ(groups("diffuse"), 1u);
  // 2 reaches of 2 mm around a pixel are 8 of 256 texels of the map's 200 mm, and groups have 16 entry
  // points.
  const uint64_t entries = groups("entry points");
  EXPECT_GT(entries, 0u);
  EXPECT_LT(entries, 64u);
  s.indirectDispatches = PELLUCID_INDIRECT_LIGHT;
  EXPECT_EQ(groups("base level"), 256u);
}

}  // namespace
