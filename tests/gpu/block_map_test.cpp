// Statistics and pictures of blocks say where the material is, which the tests know.
#include "gpu_fixture.h"

#include <numeric>

#include "replay/block_map.h"

namespace {

using namespace pellucid::test;

constexpr int kSide = 256, kBlock = PELLUCID_STATISTICS_BLOCK;

class BlockMaps : public GpuTest {
protected:
  static const Context& context() {
    static const Context shared(device());
    return shared;
  }

  static ReplaySettings gathered() {
    ReplaySettings s;
    s.translucency.gatherSamples = 8;
    return s;
  }

  static std::unique_ptr<FrameRun> run(const Capture& capture, const ReplaySettings& settings = gathered()) {
    auto frame = std::make_unique<FrameRun>(device(), context(), capture,
                                            std::vector<PellucidMaterial>{testMaterial()}, settings);
    device().run([&](VkCommandBuffer commands) { frame->record(commands); });
    return frame;
  }
};

// A slab that is lit from behind, with material within [x0, x1) x [y0, y1) alone.
Capture square(int x0, int y0, int x1, int y1) {
  Capture c = flatCapture(kSide, kSide);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z, 256)};
  c.material.assign(c.material.size(), 0);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) c.material[static_cast<size_t>(y * kSide + x)] = 1;
  return c;
}

using Counts = std::array<uint64_t, kBlockClasses>;  // empty, near, with material

TEST_F(BlockMaps, AreThoseOfASquare) {
  const auto frame = run(square(64, 32, 96, 64));
  const PellucidStatistics s = frame->statistics();
  EXPECT_EQ(s.blocks.run, 1u);
  EXPECT_EQ(s.blocks.most, 16u);
  EXPECT_EQ(s.lists, 1u);
  EXPECT_EQ(s.activeLights, 1u);
  for (const PellucidGroups& groups : {s.probes, s.entryPoints}) {
    EXPECT_GT(groups.run, 0u);
    EXPECT_LT(groups.run, groups.most);
  }
  const BlockMap map = readBlockMap(*frame);
  ASSERT_EQ(map.columns, 4);
  ASSERT_EQ(map.rows, 4);
  EXPECT_EQ(map.blocks[1], BlockClass::Material);
  EXPECT_EQ(map.counts(), (Counts{10, 5, 1})) << "3 x 2 blocks at the image's upper border";
}

// One pixel more on each side is one row of blocks more.
TEST_F(BlockMaps, CountBlocksThatMaterialTouches) {
  EXPECT_EQ(run(square(63, 31, 97, 65))->statistics().blocks.run, 4u);
  // Those of a rect lie where those of the image do.
  ReplaySettings s = gathered();
  s.renderRect = {65, 33, 31, 200};
  const BlockMap map = readBlockMap(*run(square(64, 32, 96, 64), s));
  EXPECT_EQ(map.x, 64);
  EXPECT_EQ(map.y, 0);
  EXPECT_EQ(map.columns, 1);
  EXPECT_EQ(map.rows, 4);
  EXPECT_EQ(map.counts(), (Counts{2, 1, 1}));
}

// Material at random: the statistics, the lists and a look at each pixel agree.
TEST_F(BlockMaps, AgreeWithTheLists) {
  for (const bool rect : {false, true}) {
    Capture c = square(200, 140, 231, 157);
    for (size_t i = 70; i < c.material.size(); i += 21911) c.material[i] = 1;
    c.lights.push_back(c.lights[0]);
    ReplaySettings settings = gathered();
    if (rect) settings.renderRect = {35, 21, 180, 171};
    const auto frame = run(c, settings);
    const PellucidStatistics s = frame->statistics();
    const BlockMap map = readBlockMap(*frame);
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
