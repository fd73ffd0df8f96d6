// Statistics of slices that are made by hand, as a device would leave them.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>

#include "frame_fixture.h"
#include "pellucid/pellucid_statistics.h"

namespace {

using namespace pellucid::test;

// A plan and a slice of it in which the groups of each indirect dispatch are 0.
struct Slice {
  PellucidPlan plan;
  std::vector<unsigned char> bytes;
  PellucidConstantsSlice constants{};
  PellucidStatistics statistics;
  std::string sentences;

  explicit Slice(const Frame& f) : plan(f.plan()), bytes(plan.constantsSize) {
    pellucidInitStatistics(&statistics);
    EXPECT_EQ(pellucidWriteConstants(&plan, &f.frame, bytes.data(), bytes.size()), PELLUCID_OK);
    constants.size = plan.constantsSize;
    constants.mapped = bytes.data();
  }
  uint32_t indexOf(const std::string& name) const {
    const std::vector<std::string> all = names(plan);
    const auto found = std::find(all.begin(), all.end(), name);
    EXPECT_NE(found, all.end()) << name;
    return static_cast<uint32_t>(found - all.begin());
  }
  // As the last dispatch leaves a command: its groups are counted anew, and what ran is kept behind them.
  void run(uint32_t dispatch, uint32_t x, uint32_t y = 1, uint32_t z = 1) {
    const uint32_t command[] = {0, y, z, 0, x};
    std::memcpy(&bytes[plan.dispatches[dispatch].indirectOffset], command, sizeof command);
  }
  PellucidResult read() {
    sentences.clear();
    const auto append = [](void* user, PellucidSeverity, const char* field, const char* message) {
      *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
    };
    return pellucidReadStatistics(&plan, &constants, &statistics, append, &sentences);
  }
};

// 200 x 100 pixels, 4 x 2 blocks.
struct Gathered : Frame {
  explicit Gathered(bool indirect = 1) {
    frame.imageExtent[0] = 200;
    frame.imageExtent[1] = 100;
    frame.options.gatherSamples = 8;
    frame.options.indirectDispatches = indirect;
  }
};

void expectGroups(const PellucidGroups& groups, uint64_t run, uint64_t most, const char* what) {
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
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  ASSERT_EQ(s.statistics.dispatchCount, s.plan.dispatchCount);
  for (uint32_t i = 0; i < s.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = s.plan.dispatches[i];
    const uint32_t ran = d.indirect ? columns[d.indirectOffset] : d.groups[0];
    const uint64_t others = uint64_t{d.groups[1]} * d.groups[2];
    expectGroups(s.statistics.dispatches[i], ran * others, d.groups[0] * others, d.name);
  }
  const uint32_t diffuse = s.indexOf("diffuse"), probes = s.indexOf("probes"),
                 entry = s.indexOf("entry points");
  expectGroups(s.statistics.blocks, columns[s.plan.dispatches[diffuse].indirectOffset], 4 * 2, "blocks");
  for (const auto& [groups, index] :
       {std::pair(s.statistics.probes, probes), {s.statistics.entryPoints, entry}}) {
    const PellucidGroups& own = s.statistics.dispatches[index];
    expectGroups(groups, own.run, own.most, s.plan.dispatches[index].name);
  }
  EXPECT_EQ(s.statistics.lists, 1u);
  EXPECT_EQ(s.statistics.activeLights, 1u);
}

TEST(Statistics, OfNothingAreZero) {
  Slice s{Gathered()};
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  for (const PellucidGroups* groups :
       {&s.statistics.blocks, &s.statistics.entryPoints, &s.statistics.probes}) {
    EXPECT_EQ(groups->run, 0u);
    EXPECT_GT(groups->most, 0u);
  }
  Frame idle(0);
  idle.frame.options.features = 0;
  Slice none{idle};
  ASSERT_EQ(none.plan.dispatchCount, 0u);
  ASSERT_EQ(none.read(), PELLUCID_OK) << none.sentences;
  EXPECT_EQ(none.statistics.dispatchCount, 0u);
  expectGroups(none.statistics.blocks, 0, 0, "blocks");
}

// Blocks lie at multiples of 64, wherever the rect begins.
TEST(Statistics, CountTheBlocksThatTheRectTouches) {
  for (const auto indirect : {0, 1}) {
    Gathered f(indirect);
    const uint32_t rect[] = {63, 65, 66, 10};
    std::copy(rect, rect + 4, f.frame.options.renderRect);
    Slice s{f};
    ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
    // Without lists all run, and so do those that the pyramid's border touches: rows 0 and 1.
    EXPECT_EQ(s.statistics.blocks.most, indirect == 0 ? 6u : 3u) << "columns 63 to 128";
  }
}

// The slice's content does not matter where no dispatch is indirect.
TEST(Statistics, WithoutListsAllRuns) {
  Slice s{Gathered(0)};
  std::fill(s.bytes.begin(), s.bytes.end(), static_cast<unsigned char>(0xFF));
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  for (uint32_t i = 0; i < s.statistics.dispatchCount; ++i) {
    EXPECT_GT(s.statistics.dispatches[i].most, 0u) << i;
    EXPECT_EQ(s.statistics.dispatches[i].run, s.statistics.dispatches[i].most) << i;
  }
  expectGroups(s.statistics.blocks, 5 * 3, 5 * 3, "blocks, with those that the pyramid's border touches");
  EXPECT_EQ(s.statistics.lists, 0u);
}

TEST(Statistics, ErrorsNameFieldAndValue) {
  const Slice whole{Gathered()};
  struct Case {
    std::function<void(Slice&)> change;
    PellucidResult result;
    std::string words;
  };
  const auto setSize = [](size_t size) {
    return [size](Slice& s) { s.statistics.structSize = static_cast<uint32_t>(size); };
  };
  const PellucidResult invalid = PELLUCID_ERROR_INVALID_ARGUMENT, version = PELLUCID_ERROR_VERSION;
  const Case cases[] = {
      {[](Slice& s) { s.constants.mapped = nullptr; }, invalid, "constants.mapped is NULL"},
      {[](Slice& s) { --s.constants.size; }, PELLUCID_ERROR_BUFFER_TOO_SMALL,
       "constants.size is " + std::to_string(whole.plan.constantsSize - 1)},
      {[](Slice& s) { s.run(s.indexOf("diffuse"), 9); }, invalid, "constants.mapped has 9 x 1 x 1 groups"},
      {[](Slice& s) { s.run(s.indexOf("entry points"), 1, 2, 1); }, invalid,
       "constants.mapped has 1 x 2 x 1 groups"},
      {[](Slice& s) {
         s.plan.dispatches[s.indexOf("diffuse")].indirectOffset =
             static_cast<uint32_t>(s.plan.constantsSize - 8);
       },
       invalid, "].indirectOffset is " + std::to_string(whole.plan.constantsSize - 8)},
      {[](Slice& s) { s.plan.dispatchCount = PELLUCID_MAX_DISPATCHES + 1; }, invalid,
       "plan.dispatchCount is 33"},
      {setSize(0), version, "statistics.structSize is 0"},
      {setSize(sizeof(PellucidStatistics) - 8), version, "statistics.structSize is "},
      {setSize(sizeof(PellucidStatistics) + 4), version, "statistics.structSize is "},
      {setSize(4104), version, "statistics.structSize is 4104"}};
  for (const Case& c : cases) {
    Slice s{Gathered()};
    c.change(s);
    s.statistics.blocks.run = 77;
    EXPECT_EQ(s.read(), c.result) << c.words;
    EXPECT_NE(s.sentences.find(c.words), std::string::npos) << s.sentences << "is not " << c.words;
    EXPECT_EQ(s.statistics.blocks.run, 77u) << c.words << ": written all the same";
    // A caller need not listen.
    EXPECT_EQ(pellucidReadStatistics(&s.plan, &s.constants, &s.statistics, nullptr, nullptr), c.result);
  }
  Slice s{Gathered()};
  EXPECT_EQ(pellucidReadStatistics(nullptr, &s.constants, &s.statistics, nullptr, nullptr), invalid);
  EXPECT_EQ(pellucidReadStatistics(&s.plan, nullptr, &s.statistics, nullptr, nullptr), invalid);
  EXPECT_EQ(pellucidReadStatistics(&s.plan, &s.constants, nullptr, nullptr, nullptr), invalid);
}

// A newer caller's fields become 0, and its size stays.
TEST(Statistics, LongerStructsAreFilled) {
  struct Newer {
    PellucidStatistics known;
    uint64_t more[2];
  } newer;
  std::memset(static_cast<void*>(&newer), 0xAB, sizeof newer);
  newer.known.structSize = sizeof newer;
  const Slice s{Gathered()};
  ASSERT_EQ(pellucidReadStatistics(&s.plan, &s.constants, &newer.known, nullptr, nullptr), PELLUCID_OK);
  EXPECT_EQ(newer.known.structSize, sizeof newer);
  EXPECT_EQ(newer.known.blocks.most, 8u);
  EXPECT_EQ(newer.more[0], 0u);
  EXPECT_EQ(newer.more[1], 0u);
}

}  // namespace
