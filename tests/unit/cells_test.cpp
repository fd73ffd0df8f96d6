// Words of cells that the caller hands in: what a frame asks for, and its plan.
#include "pellucid/pellucid_cells.h"

#include <cstring>

#include "frame_fixture.h"

namespace {

using namespace pellucid::test;

// 100 x 50 pixels, gathered from one light.
struct Handed : Frame {
  Handed() {
    frame.indirectDispatches = PELLUCID_INDIRECT_CELLS;
    frame.gatherSamples = 8;
  }
  void setRect(uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    const uint32_t rect[] = {x, y, width, height};
    std::copy(rect, rect + 4, frame.renderRect);
  }
  PellucidCells cells() const {
    PellucidCells cells;
    EXPECT_EQ(pellucidGetCells(&frame, &cells), PELLUCID_OK) << problems();
    return cells;
  }
};

bool isNone(const PellucidCells& cells) {
  const PellucidCells none{};
  return std::memcmp(&cells, &none, sizeof none) == 0;
}

TEST(Cells, BlocksCoverTheRectFromAnEvenPixelOn) {
  Handed f;
  const PellucidCells whole = f.cells();
  EXPECT_EQ(whole.blocks[0], 2u);
  EXPECT_EQ(whole.blocks[1], 1u);
  EXPECT_EQ(whole.firstPixel[0], 0u);
  EXPECT_EQ(whole.firstPixel[1], 0u);
  f.frame.imageExtent[0] = f.frame.imageExtent[1] = 400;
  f.setRect(13, 28, 127, 65);  // 12..140, 28..93
  const PellucidCells part = f.cells();
  EXPECT_EQ(part.blocks[0], 2u);
  EXPECT_EQ(part.blocks[1], 2u);
  EXPECT_EQ(part.firstPixel[0], 12u);
  EXPECT_EQ(part.firstPixel[1], 28u);
  f.setRect(13, 28, 128, 64);
  EXPECT_EQ(f.cells().blocks[0], 3u) << "129 pixels from the even one on";
  EXPECT_EQ(f.cells().blocks[1], 1u);
}

// Images of any size that devices have keep their lists: groups of a dispatch stay within 65535 along an
// axis, and the image of words has room for the lists of any rect.
TEST(Cells, LargeImagesKeepTheirLists) {
  const auto wordsOf = [](const Handed& f) {
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS + 1];
    uint32_t count = PELLUCID_MAX_TRANSIENTS + 1;
    EXPECT_EQ(pellucidGetImageNeeds(&f.frame, &count, needs), PELLUCID_OK);
    for (uint32_t i = 0; i < count; ++i)
      if (needs[i].format == VK_FORMAT_R32_UINT) return needs[i].extent[0] * needs[i].extent[1];
    return 0u;
  };
  const struct {
    uint32_t width, height, spacing, rows;  // rows: of tiles in a listed one
  } sizes[] = {
      {4080, 4112, 0, 1}, {4096, 4096, 0, 2}, {7680, 4320, 0, 2}, {7680, 4320, 1, 2}, {16384, 4096, 0, 5}};
  for (const auto& [width, height, spacing, rows] : sizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    Handed f;
    f.frame.imageExtent[0] = width;
    f.frame.imageExtent[1] = height;
    f.frame.gatherSpacing = spacing;
    for (PellucidImage& image : f.frame.transients) image = Frame::view();
    ASSERT_EQ(f.problems(), "");
    const uint32_t words = wordsOf(f);
    for (const bool half : {false, true}) {
      if (half) f.setRect(33, 17, width / 2, height / 2);
      const PellucidPlan plan = f.plan();
      EXPECT_EQ(wordsOf(f), words) << "for any rect";
      uint32_t listed = 0;
      for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
        const PellucidDispatch& d = plan.dispatches[i];
        for (const uint32_t groups : d.groups) EXPECT_LE(groups, 65535u) << d.name;
        listed += d.indirect;
        if (d.name == std::string("base level")) {
          EXPECT_EQ(d.groups[1], rows);
        }
      }
      EXPECT_GT(listed, 5u);
      EXPECT_FALSE(skips(plan, "tile lists", "the image has more groups than lists can hold"));
    }
  }
}

// The transient is the one of whole numbers, in use from the plan's beginning on, and has room for all words.
TEST(Cells, LieInATransient) {
  for (const uint32_t samples : {0u, 8u}) {
    Handed f;
    f.frame.gatherSamples = samples;
    f.setRect(3, 5, 90, 40);
    const PellucidCells cells = f.cells();
    EXPECT_EQ(cells.distances, samples > 0 ? 1u : 0u);
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t count = PELLUCID_MAX_TRANSIENTS;
    ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &count, needs), PELLUCID_OK);
    ASSERT_LT(cells.transient, count);
    const PellucidImageNeed& need = needs[cells.transient];
    EXPECT_EQ(need.format, VK_FORMAT_R32_UINT);
    EXPECT_EQ(need.firstDispatch, 0u);
    EXPECT_EQ(need.extent[0], static_cast<uint32_t>(PELLUCID_CELL_IMAGE_COLUMNS));
    EXPECT_GE(need.extent[0] * need.extent[1], cells.blocks[0] * cells.blocks[1] * PELLUCID_CELL_BLOCK_WORDS);
    const PellucidPlan plan = f.plan();
    const PellucidDispatch& first = plan.dispatches[0];
    bool bound = false;
    for (uint32_t i = 0; i < first.bindingCount; ++i)
      bound = bound || first.bindings[i].resource == PELLUCID_RESOURCE_TRANSIENT0 + cells.transient;
    EXPECT_TRUE(bound) << first.name;
  }
}

// The plan is that of MATERIAL without the dispatch that finds cells and the barrier behind it.
TEST(Cells, ThePlanDoesNotFindThem) {
  Handed f;
  const PellucidPlan plan = f.plan();
  f.frame.indirectDispatches = PELLUCID_INDIRECT_MATERIAL;
  const PellucidPlan finds = f.plan();
  std::vector<std::string> expected = names(finds);
  ASSERT_EQ(expected[0], "find cells");
  expected.erase(expected.begin());
  EXPECT_EQ(names(plan), expected);
  EXPECT_EQ(plan.barrierCount + 1, finds.barrierCount);
  EXPECT_EQ(plan.dispatches[0].barrierBefore, 0u);
  for (uint32_t i = 1; i < plan.dispatchCount; ++i) {
    EXPECT_EQ(plan.dispatches[i].indirect, finds.dispatches[i + 1].indirect) << i;
    EXPECT_EQ(plan.dispatches[i].barrierIndirect, finds.dispatches[i + 1].barrierIndirect) << i;
  }
}

// Nothing in the plan empties the lists.
TEST(Cells, ConstantsBeginWithEmptyLists) {
  Handed f;
  f.frame.gatherSpacing = 4;  // the diffusion adds what was gathered
  const PellucidPlan plan = f.plan();
  std::vector<unsigned char> slice(plan.constantsSize, 0xFF);
  ASSERT_EQ(pellucidWriteConstants(&plan, &f.frame, slice.data(), slice.size()), PELLUCID_OK);
  uint32_t indirect = 0;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (!d.indirect) continue;
    ++indirect;
    uint32_t command[4];
    std::memcpy(command, &slice[d.indirectOffset], sizeof command);
    EXPECT_EQ(command[0], 0u) << d.name;
    EXPECT_EQ(command[1], 1u) << d.name;
    EXPECT_EQ(command[2], 1u) << d.name;
    EXPECT_EQ(command[3], 0u) << d.name << ": listed, before it is known whether they run";
  }
  EXPECT_EQ(indirect + 1, plan.dispatchCount) << "all but the dispatch that lists groups";
}

TEST(Cells, FramesWithoutListsAskForNone) {
  for (const uint32_t indirect :
       {PELLUCID_INDIRECT_NONE, PELLUCID_INDIRECT_MATERIAL, PELLUCID_INDIRECT_LIGHT}) {
    Handed f;
    f.frame.indirectDispatches = indirect;
    EXPECT_TRUE(isNone(f.cells())) << indirect;
  }
  Handed f;
  f.frame.features = PELLUCID_FEATURE_TRANSLUCENCY;
  EXPECT_TRUE(isNone(f.cells())) << "nothing diffuses";
  f.frame.features |= PELLUCID_FEATURE_DIFFUSION;
  EXPECT_FALSE(isNone(f.cells()));
  f.frame.gatherSamples = 0;
  f.frame.reuse = PELLUCID_REUSE_ALTERNATE;
  EXPECT_TRUE(isNone(f.cells()));
  EXPECT_TRUE(skips(f.plan(), "tile lists", "frame.reuse keeps the light of pixels, all of which it writes"));
}

TEST(Cells, RefusedFramesLeaveTheStruct) {
  Handed f;
  PellucidCells cells;
  std::memset(&cells, 0x7B, sizeof cells);
  const PellucidCells before = cells;
  EXPECT_EQ(pellucidGetCells(nullptr, &cells), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidGetCells(&f.frame, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  f.frame.imageExtent[0] = 0;
  EXPECT_EQ(pellucidGetCells(&f.frame, &cells), PELLUCID_ERROR_INVALID_ARGUMENT);
  f.frame.structSize = 7;
  EXPECT_EQ(pellucidGetCells(&f.frame, &cells), PELLUCID_ERROR_VERSION);
  EXPECT_EQ(std::memcmp(&cells, &before, sizeof cells), 0);
}

}  // namespace
