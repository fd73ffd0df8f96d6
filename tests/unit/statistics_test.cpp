// Statistics of slices that are made by hand, as a device would leave them.
#include "replay/statistics.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "frame_fixture.h"

namespace {

using namespace pellucid::test;
using pellucid::harness::Groups;
using pellucid::harness::readStatistics;
using pellucid::harness::Statistics;

// A plan and a slice of it in which the groups of each indirect dispatch are 0.
struct Slice {
  PellucidPlan plan;
  std::vector<unsigned char> bytes;

  explicit Slice(const Frame& f) : plan(f.plan()), bytes(plan.constantsSize) {
    EXPECT_EQ(pellucidWriteConstants(&plan, &f.frame, bytes.data(), bytes.size()), PELLUCID_OK);
  }
  uint32_t indexOf(const std::string& name) const {
    const std::vector<std::string> all = names(plan);
    const auto found = std::find(all.begin(), all.end(), name);
    EXPECT_NE(found, all.end()) << name;
    return static_cast<uint32_t>(found - all.begin());
  }
  // As the last dispatch leaves a command: its groups are counted anew, and what ran is kept behind them.
  void run(uint32_t dispatch, uint32_t x, uint32_t y, uint32_t z) {
    const uint32_t command[] = {0, y, z, 0, x};
    std::memcpy(&bytes[plan.dispatches[dispatch].indirectOffset], command, sizeof command);
  }
  Statistics read() const { return readStatistics(plan, bytes.data()); }
};

// 200 x 100 pixels, 4 x 2 blocks.
struct Gathered : Frame {
  explicit Gathered(uint32_t indirect = 1) {
    frame.imageExtent[0] = 200;
    frame.imageExtent[1] = 100;
    frame.options.gatherSamples = 8;
    frame.options.indirectDispatches = indirect;
  }
};

void expectGroups(const Groups& groups, uint64_t run, uint64_t most, const char* what) {
  EXPECT_EQ(groups.run, run) << what;
  EXPECT_EQ(groups.most, most) << what;
}

// Several dispatches may go by one command.
TEST(Statistics, AreTheSlicesCommands) {
  Slice s{Gathered()};
  std::map<VkDeviceSize, uint32_t> columns;
  for (uint32_t i = 0; i < s.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = s.plan.dispatches[i];
    if (!d.indirect) continue;
    const auto some = static_cast<uint32_t>(columns.size()) % d.groups[0];
    s.run(i, columns.try_emplace(d.indirectOffset, some + 1).first->second, d.groups[1], d.groups[2]);
  }
  EXPECT_GE(columns.size(), 5u) << "near material, of material, two coarse ones and entry points";
  const Statistics statistics = s.read();
  ASSERT_EQ(statistics.dispatches.size(), s.plan.dispatchCount);
  for (uint32_t i = 0; i < s.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = s.plan.dispatches[i];
    const uint32_t ran = d.indirect ? columns[d.indirectOffset] : d.groups[0];
    const uint64_t others = uint64_t{d.groups[1]} * d.groups[2];
    expectGroups(statistics.dispatches[i], ran * others, d.groups[0] * others, d.name);
  }
  const uint32_t diffuse = s.indexOf("diffuse"), probes = s.indexOf("probes"),
                 entry = s.indexOf("entry points");
  expectGroups(statistics.blocks, columns[s.plan.dispatches[diffuse].indirectOffset], 4 * 2, "blocks");
  for (const auto& [groups, index] :
       {std::pair(statistics.probes, probes), {statistics.entryPoints, entry}}) {
    const Groups& own = statistics.dispatches[index];
    expectGroups(groups, own.run, own.most, s.plan.dispatches[index].name);
  }
  EXPECT_TRUE(statistics.lists);
}

TEST(Statistics, OfNothingAreZero) {
  const Statistics s = Slice{Gathered()}.read();
  for (const Groups& groups : {s.blocks, s.entryPoints, s.probes}) {
    EXPECT_EQ(groups.run, 0u);
    EXPECT_GT(groups.most, 0u);
  }
  Frame idle(0);
  idle.frame.options.features = 0;
  const Statistics none = Slice{idle}.read();
  EXPECT_TRUE(none.dispatches.empty());
  expectGroups(none.blocks, 0, 0, "blocks");
}

// Blocks lie at multiples of 64, wherever the rect begins.
TEST(Statistics, CountTheBlocksThatTheRectTouches) {
  for (const uint32_t indirect : {0, 1}) {
    Gathered f(indirect);
    const uint32_t rect[] = {63, 65, 66, 10};
    std::copy(rect, rect + 4, f.frame.options.renderRect);
    // Without lists all run, and so do those that the pyramid's border touches: rows 0 and 1.
    EXPECT_EQ(Slice{f}.read().blocks.most, indirect == 0 ? 6u : 3u) << "columns 63 to 128";
  }
}

// The slice's content does not matter where no dispatch is indirect.
TEST(Statistics, WithoutListsAllRuns) {
  Slice s{Gathered(0)};
  std::fill(s.bytes.begin(), s.bytes.end(), static_cast<unsigned char>(0xFF));
  const Statistics statistics = s.read();
  for (const Groups& groups : statistics.dispatches) {
    EXPECT_GT(groups.most, 0u);
    EXPECT_EQ(groups.run, groups.most);
  }
  expectGroups(statistics.blocks, 5 * 3, 5 * 3, "blocks, with those that the pyramid's border touches");
  EXPECT_FALSE(statistics.lists);
}

}  // namespace
