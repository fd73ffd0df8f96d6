// Lists of blocks change where passes run and no pixel.
#include <algorithm>
#include <random>

#include "gpu_fixture.h"
#include "replay/block_map.h"

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
       s.renderRect = {67, 33, 131, 90};
     }},
    // Indices with noise around them.
    {"a material mask",
     [](ReplaySettings& s) {
       s.materialShift = 4;
       s.materialMask = 0xFF0;
     }},
    {"a distance that is known", [](ReplaySettings& s) { s.nearestDistance = 10; }},
};

// The transients hold NaN before each recording, so that a texel that no group wrote shows.
TEST_F(Lists, ChangeNoPixel) {
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (const Way& way : kWays) {
      Capture c = islands(260 + 3 * static_cast<int>(seed), 190, seed);
      if (seed == 2) c = inPerspective(std::move(c));
      if (seed > 1) c = withDeviceDepth(std::move(c));
      ReplaySettings s;
      s.translucency.gatherSamples = 8;
      way.change(s);
      s.indirectDispatches = 0;
      const Image whole = replayer().run(c, {testMaterial()}, s).output;
      s.indirectDispatches = 1;
      const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
      // A recording may run more than once.
      for (int times = 0; times < 2; ++times) {
        device().run([&](VkCommandBuffer commands) { run.record(commands); });
        EXPECT_TRUE(sameBits(run.output(), whole)) << way.name << ", seed " << seed << ", run " << times;
      }
    }
}

TEST_F(Lists, GroupsFollowTheMaterial) {
  const Context context(device());
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  Capture c = islands(256, 256, 1);
  // How many groups of a dispatch ran.
  const auto groups = [&](const char* name) {
    const FrameRun run(device(), context, c, {testMaterial()}, s);
    device().run([&](VkCommandBuffer commands) { run.record(commands); });
    const PellucidStatistics statistics = run.statistics();
    for (uint32_t i = 0; i < statistics.dispatchCount; ++i)
      if (run.plan().dispatches[i].name == std::string(name)) return statistics.dispatches[i];
    ADD_FAILURE() << name;
    return PellucidGroups{};
  };
  constexpr const char* kListed[] = {"downsample",   "upsample", "diffuse",
                                     "entry points", "probes",   "filter probes"};
  c.material.assign(c.material.size(), 0);
  for (const char* name : kListed) EXPECT_EQ(groups(name).run, 0u) << name << " of nothing";
  c.material[128 * 256 + 128] = 1;  // the first pixel of one of 16 blocks
  // The pyramid's border touches one more block on each side.
  for (const auto& [name, blocks, most] :
       {std::tuple("downsample", 9u, 36u), {"upsample", 9u, 36u}, {"diffuse", 1u, 16u}}) {
    const PellucidGroups found = groups(name);
    EXPECT_EQ(most * found.run, blocks * found.most) << name;
  }
  // 2 reaches of 2 mm around a pixel are 8 of 256 texels of the map's 200 mm, and groups have 16 entry
  // points.
  const uint64_t entries = groups("entry points").run;
  EXPECT_GT(entries, 0u);
  EXPECT_LT(entries, 64u);
  s.indirectDispatches = 0;
  for (const char* name : kListed) EXPECT_EQ(groups(name).run, groups(name).most) << name;
}

// Material at random: the statistics, the lists and a look at each pixel agree.
TEST_F(Lists, StatisticsAndBlocksAreThoseOfTheMaterial) {
  constexpr int kSide = 256, kBlock = PELLUCID_STATISTICS_BLOCK;
  for (const bool rect : {false, true}) {
    Capture c = islands(kSide, kSide, 2);
    c.lights.push_back(c.lights[0]);
    ReplaySettings settings;
    settings.translucency.gatherSamples = 8;
    if (rect) settings.renderRect = {35, 21, 180, 171};
    const FrameRun frame(device(), replayer().contextFor(c), c, {testMaterial()}, settings);
    device().run([&](VkCommandBuffer commands) { frame.record(commands); });
    const PellucidStatistics s = frame.statistics();
    const BlockMap map = readBlockMap(frame);
    std::vector<BlockClass> expected(map.blocks.size(), BlockClass::Empty);
    const auto at = [&](int column, int row) -> BlockClass& {
      return expected[static_cast<size_t>(row * map.columns + column)];
    };
    for (int y = map.rect[1]; y < map.rect[3]; ++y)
      for (int x = map.rect[0]; x < map.rect[2]; ++x)
        if (c.material[static_cast<size_t>(y * kSide + x)] != 0)
          at((x - map.x) / kBlock, (y - map.y) / kBlock) = BlockClass::Material;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column) {
        if (at(column, row) != BlockClass::Material) continue;
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, map.rows - 1); ++y)
          for (int x = std::max(column - 1, 0); x <= std::min(column + 1, map.columns - 1); ++x)
            at(x, y) = std::max(at(x, y), BlockClass::Near);
      }
    EXPECT_EQ(map.blocks, expected) << rect;
    const auto blocks =
        static_cast<uint64_t>(std::count(expected.begin(), expected.end(), BlockClass::Material));
    EXPECT_GT(blocks, 1u);
    EXPECT_EQ(s.blocks.run, blocks) << "a block is listed twice";
    EXPECT_EQ(s.blocks.most, map.blocks.size());
    EXPECT_GT(s.entryPoints.run, 0u);
    EXPECT_EQ(s.entryPoints.run % 2, 0u) << "two maps that are alike";
  }
}

}  // namespace
