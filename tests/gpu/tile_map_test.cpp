// Statistics and pictures of tiles say where the material is, which the tests know.
#include "gpu_fixture.h"

#include <bit>
#include <numeric>

#include "replay/tile_map.h"

namespace {

using namespace pellucid::test;

constexpr int kSide = 256, kTile = PELLUCID_STATISTICS_TILE;

class TileMaps : public GpuTest {
protected:
  static const Context& context() {
    static const Context shared(device());
    return shared;
  }

  // All of its light is gathered, so that the device decides about the passes after the probes.
  static ReplaySettings gathered() {
    ReplaySettings s;
    s.translucency.gatherSamples = 8;
    s.translucency.gatherSpacing = 4;
    return s;
  }

  static std::unique_ptr<FrameRun> run(const Capture& capture, const ReplaySettings& settings) {
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

bool hasMaterial(const TileMap& map, int column, int row) {
  return (map.bits[static_cast<size_t>(row * map.columns + column)] & kTileMaterial) != 0;
}

// Bits of cells of 8 x 8 pixels: two of the four words of each block of 64 x 64.
int cellsOf(const FrameRun& run) {
  const std::vector<uint32_t> words = run.tileWords();
  int cells = 0;
  for (size_t block = 0; block < 16; ++block)
    cells += std::popcount(words[4 * block]) + std::popcount(words[4 * block + 1]);
  return cells;
}

TEST_F(TileMaps, AreThoseOfASquare) {
  const auto frame = run(square(64, 32, 96, 64), gathered());
  const PellucidStatistics s = frame->statistics();
  EXPECT_EQ(s.tiles.run, 4u) << "32 pixels a side in tiles of 16";
  EXPECT_EQ(s.tiles.most, 256u);
  EXPECT_EQ(s.tileLists, 1u);
  EXPECT_EQ(cellsOf(*frame), 16) << "32 pixels a side in cells of 8";
  EXPECT_EQ(s.gatheredLight, uint32_t{PELLUCID_GATHERED_SOME});
  EXPECT_EQ(s.activeLights, 1u);
  const TileMap map = readTileMap(*frame);
  ASSERT_EQ(map.columns, 16);
  ASSERT_EQ(map.rows, 16);
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 16; ++column)
      EXPECT_EQ(hasMaterial(map, column, row), (column == 4 || column == 5) && (row == 2 || row == 3))
          << column << ", " << row;
  EXPECT_EQ(map.counts()[kTileMaterial | kTileProbes | kTileDiffuses], 4u);
  // Probes lie in groups of 32 x 32 pixels and are needed four cells of 4 pixels around material.
  EXPECT_EQ(s.probes.run, 9u);
  uint64_t probes = 0;
  for (const unsigned tile : map.bits) probes += (tile & kTileProbes) != 0;
  EXPECT_EQ(probes, 9u * 4);
  // Groups that diffuse do 60 x 16 pixels: the second of two rows of groups holds the square.
  EXPECT_EQ(s.diffusion.run, 2u);
}

// One pixel more on each side is one row of tiles and cells more.
TEST_F(TileMaps, CountTilesThatMaterialTouches) {
  const auto frame = run(square(63, 31, 97, 65), gathered());
  EXPECT_EQ(frame->statistics().tiles.run, 16u);
  EXPECT_EQ(cellsOf(*frame), 36);
  // Tiles of a rect begin at an even pixel, and hold no pixel beyond it.
  ReplaySettings s = gathered();
  s.renderRect = {65, 33, 31, 200};
  const TileMap map = readTileMap(*run(square(64, 32, 96, 64), s));
  EXPECT_EQ(map.x, 64);
  EXPECT_EQ(map.y, 32);
  EXPECT_EQ(map.columns, 2);
  EXPECT_EQ(map.rows, 13);
  uint64_t tiles = 0;
  for (const unsigned tile : map.bits) tiles += (tile & kTileMaterial) != 0;
  EXPECT_EQ(tiles, 4u);
}

TEST_F(TileMaps, OfNothingAreEmpty) {
  const auto frame = run(square(0, 0, 0, 0), gathered());
  const PellucidStatistics s = frame->statistics();
  EXPECT_EQ(s.tiles.run, 0u);
  EXPECT_EQ(s.diffusion.run, 0u);
  EXPECT_EQ(s.probes.run, 0u);
  EXPECT_EQ(s.entryPoints.run, 0u);
  EXPECT_EQ(s.gatheredLight, uint32_t{PELLUCID_GATHERED_NONE});
  EXPECT_EQ(cellsOf(*frame), 0);
  const TileMap map = readTileMap(*frame);
  EXPECT_EQ(map.counts()[0], 256u);
  EXPECT_EQ(map.entryGroups, std::vector<uint64_t>{0});
}

// Light enters through surfaces that its map stores: a map of nothing has no entry points.
TEST_F(TileMaps, SayThatNoLightWasGathered) {
  Capture c = square(64, 32, 96, 64);
  Image& depth = c.lights[0].shadowMaps[0].depth.image;
  depth = Image(depth.width, depth.height, 1, 1e9f);
  const PellucidStatistics s = run(c, gathered())->statistics();
  EXPECT_EQ(s.gatheredLight, uint32_t{PELLUCID_GATHERED_NONE});
  EXPECT_EQ(s.diffusion.run, 2u);
}

// Material at random: the statistics, the lists and a look at each pixel agree.
TEST_F(TileMaps, AgreeWithTheLists) {
  for (const uint32_t spacing : {1u, 2u, 4u})
    for (const bool rect : {false, true}) {
      Capture c = square(100, 40, 131, 57);
      for (size_t i = 0; i < c.material.size(); i += 7919) c.material[i] = 1;
      c.lights.push_back(c.lights[0]);
      ReplaySettings settings = gathered();
      settings.translucency.gatherSpacing = spacing;
      if (rect) settings.renderRect = {35, 21, 150, 131};
      const auto frame = run(c, settings);
      const PellucidStatistics s = frame->statistics();
      const TileMap map = readTileMap(*frame);
      std::vector<bool> expected(map.bits.size());
      for (int y = map.rect[1]; y < map.rect[3]; ++y)
        for (int x = map.rect[0]; x < map.rect[2]; ++x)
          if (c.material[static_cast<size_t>(y * kSide + x)] != 0)
            expected[static_cast<size_t>((y - map.y) / kTile * map.columns + (x - map.x) / kTile)] = true;
      uint64_t tiles = 0;
      for (size_t i = 0; i < expected.size(); ++i) {
        tiles += expected[i];
        EXPECT_EQ((map.bits[i] & kTileMaterial) != 0, expected[i]) << i;
        if (!expected[i]) continue;
        EXPECT_EQ(map.bits[i], kTileMaterial | kTileProbes | kTileDiffuses)
            << i << ": its pixels lack a pass";
      }
      EXPECT_GT(tiles, rect ? 5u : 8u);
      EXPECT_EQ(s.tiles.run, tiles) << "a tile is listed twice";
      EXPECT_EQ(s.tiles.most, map.bits.size());
      ASSERT_EQ(map.entryGroups.size(), 2u);
      EXPECT_GT(map.entryGroups[0], 0u);
      EXPECT_EQ(map.entryGroups[0], map.entryGroups[1]) << "two maps that are alike";
      EXPECT_EQ(map.entryGroups[0] + map.entryGroups[1], s.entryPoints.run);
    }
}

// Class of a pixel that a tile begins with.
unsigned classAt(const std::vector<uint8_t>& srgb, int x, int y) {
  for (unsigned bits = 0; bits < kTileClasses; ++bits)
    if (std::equal(tileClass(bits).srgb.begin(), tileClass(bits).srgb.end(),
                   srgb.begin() + 3 * (y * kSide + x)))
      return bits;
  return kTileClasses;
}

TEST_F(TileMaps, AreDrawnOverThePicture) {
  ReplaySettings settings = gathered();
  settings.renderRect = {33, 17, 128, 96};
  const TileMap map = readTileMap(*run(square(64, 32, 96, 64), settings));
  std::vector<uint8_t> picture(3 * kSide * kSide, 90);
  drawTileMap(map, kSide, kSide, picture);
  // The first row and column of pixels lie before the rect.
  for (int row = 1; row < map.rows; ++row)
    for (int column = 1; column < map.columns; ++column)
      EXPECT_EQ(classAt(picture, map.x + column * kTile, map.y + row * kTile),
                map.bits[static_cast<size_t>(row * map.columns + column)])
          << column << ", " << row;
  const auto at = [&](int x, int y) { return picture[3 * static_cast<size_t>(y * kSide + x)]; };
  EXPECT_EQ(at(70, 40), (2 * 90 + tileClass(7).srgb[0]) / 3);
  for (const auto& [x, y] : {std::pair{32, 40}, {161, 40}, {70, 16}, {70, 113}})
    EXPECT_EQ(at(x, y), 90) << "outside the rect";
  const std::string legend = tileLegend(map);
  EXPECT_NE(legend.find("green             4  material, has probes and diffuses"), std::string::npos)
      << legend;
  EXPECT_EQ(legend.find("yellow"), std::string::npos) << legend;
}

TEST_F(TileMaps, SayWhyThereAreNone) {
  const auto why = [&](const auto& change) {
    ReplaySettings s = gathered();
    change(s);
    const auto frame = run(square(64, 32, 96, 64), s);
    EXPECT_EQ(frame->statistics().tileLists, 0u);
    try {
      readTileMap(*frame);
      ADD_FAILURE() << "is drawn";
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(why([](ReplaySettings& s) { s.indirectDispatches = PELLUCID_INDIRECT_LIGHT; }),
            "flat: has no tile lists to draw: frame.indirectDispatches asks for none");
  EXPECT_EQ(why([](ReplaySettings& s) { s.features = PELLUCID_FEATURE_TRANSLUCENCY; }),
            "flat: has no tile lists to draw: nothing diffuses: not among the features");
  EXPECT_EQ(why([](ReplaySettings& s) {
              s.translucency.gatherSamples = 0;
              s.reuse = PELLUCID_REUSE_ALTERNATE;
            }),
            "flat: has no tile lists to draw: frame.reuse keeps the light of pixels, all of which it writes");
}

}  // namespace
