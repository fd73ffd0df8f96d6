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
  void run(uint32_t dispatch, uint32_t x, uint32_t y = 1, uint32_t z = 1) {
    const VkDispatchIndirectCommand command{x, y, z};
    std::memcpy(&bytes[plan.dispatches[dispatch].indirectOffset], &command, sizeof command);
  }
  PellucidResult read() {
    sentences.clear();
    const auto append = [](void* user, PellucidSeverity, const char* field, const char* message) {
      *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
    };
    return pellucidReadStatistics(&plan, &constants, &statistics, append, &sentences);
  }
};

// All of its light is gathered, so that the device decides about the passes after the probes.
struct Gathered : Frame {
  explicit Gathered(PellucidIndirect indirect = PELLUCID_INDIRECT_MATERIAL) {
    frame.gatherSamples = 8;
    frame.gatherSpacing = 4;
    frame.indirectDispatches = indirect;
  }
};

void expectGroups(const PellucidGroups& groups, uint64_t run, uint64_t most, const char* what) {
  EXPECT_EQ(groups.run, run) << what;
  EXPECT_EQ(groups.most, most) << what;
}

// The image is 100 x 50: 7 x 4 tiles of 16 pixels, 25 x 13 cells of 4 in groups of 8, and a map of 64 texels
// a side.
TEST(Statistics, AreTheSlicesCommands) {
  Slice s{Gathered()};
  std::map<std::string, uint32_t> ran = {{"base level", 5}, {"entry points", 3}, {"probes", 2},
                                         {"upsample", 1},   {"downsample", 1},   {"filter probes", 1},
                                         {"diffuse", 2}};
  for (const auto& [name, groups] : ran) s.run(s.indexOf(name), groups);
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  ASSERT_EQ(s.statistics.dispatchCount, s.plan.dispatchCount);
  std::map<std::string, bool> seen;
  for (uint32_t i = 0; i < s.plan.dispatchCount; ++i) {
    const PellucidDispatch& d = s.plan.dispatches[i];
    const uint64_t most = uint64_t{d.groups[0]} * d.groups[1] * d.groups[2];
    const bool first = !std::exchange(seen[d.name], true);
    expectGroups(s.statistics.dispatches[i], !d.indirect ? most : first ? ran[d.name] : 0, most, d.name);
  }
  expectGroups(s.statistics.tiles, 5, 7 * 4, "tiles");
  expectGroups(s.statistics.probes, 2, 4 * 2, "probes");
  expectGroups(s.statistics.entryPoints, 3, s.statistics.dispatches[s.indexOf("entry points")].most,
               "entry points");
  expectGroups(s.statistics.diffusion, 2, s.statistics.dispatches[s.indexOf("diffuse")].most, "diffusion");
  EXPECT_EQ(s.statistics.tileLists, 1u);
  EXPECT_EQ(s.statistics.gatheredLight, uint32_t{PELLUCID_GATHERED_SOME});
  EXPECT_EQ(s.statistics.activeLights, 1u);
}

TEST(Statistics, SayThatNoLightWasGathered) {
  Slice s{Gathered()};
  s.run(s.indexOf("diffuse, none gathered"), 4);
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  EXPECT_EQ(s.statistics.gatheredLight, uint32_t{PELLUCID_GATHERED_NONE});
  EXPECT_EQ(s.statistics.diffusion.run, 4u);
}

TEST(Statistics, OfNothingAreZero) {
  Slice s{Gathered()};
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  for (const PellucidGroups* groups :
       {&s.statistics.tiles, &s.statistics.diffusion, &s.statistics.entryPoints, &s.statistics.probes}) {
    EXPECT_EQ(groups->run, 0u);
    EXPECT_GT(groups->most, 0u);
  }
  EXPECT_EQ(s.statistics.gatheredLight, uint32_t{PELLUCID_GATHERED_NONE});
}

// With PELLUCID_INDIRECT_LIGHT the commands start as those of a frame without gathered light.
TEST(Statistics, WithoutTileListsOnlyLightDecides) {
  Slice s{Gathered(PELLUCID_INDIRECT_LIGHT)};
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  EXPECT_EQ(s.statistics.tileLists, 0u);
  expectGroups(s.statistics.tiles, 7 * 4, 7 * 4, "tiles");
  EXPECT_EQ(s.statistics.gatheredLight, uint32_t{PELLUCID_GATHERED_NONE});
  EXPECT_EQ(s.statistics.diffusion.run, s.statistics.diffusion.most);
  EXPECT_EQ(s.statistics.dispatches[s.indexOf("filter probes")].run, 0u);
}

// The slice's content does not matter where no dispatch is indirect.
TEST(Statistics, WithoutIndirectDispatchesAllRuns) {
  Slice s{Gathered(PELLUCID_INDIRECT_NONE)};
  std::fill(s.bytes.begin(), s.bytes.end(), static_cast<unsigned char>(0xFF));
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  for (uint32_t i = 0; i < s.statistics.dispatchCount; ++i) {
    EXPECT_GT(s.statistics.dispatches[i].most, 0u) << i;
    EXPECT_EQ(s.statistics.dispatches[i].run, s.statistics.dispatches[i].most) << i;
  }
  EXPECT_EQ(s.statistics.gatheredLight, uint32_t{PELLUCID_GATHERED_UNKNOWN});
}

TEST(Statistics, OfAPlanOfNothingAreEmpty) {
  Frame f(0);
  f.frame.features = 0;
  Slice s{f};
  ASSERT_EQ(s.plan.dispatchCount, 0u);
  ASSERT_EQ(s.read(), PELLUCID_OK) << s.sentences;
  EXPECT_EQ(s.statistics.dispatchCount, 0u);
  expectGroups(s.statistics.tiles, 0, 0, "tiles");
}

TEST(Statistics, ErrorsNameFieldAndValue) {
  const Slice whole{Gathered()};
  struct Case {
    std::function<void(Slice&)> change;
    PellucidResult result;
    std::string sentence;
  };
  const std::string bytes = std::to_string(whole.plan.constantsSize);
  const Case cases[] = {
      {[](Slice& s) { s.constants.mapped = nullptr; }, PELLUCID_ERROR_INVALID_ARGUMENT,
       "constants.mapped is NULL"},
      {[](Slice& s) { --s.constants.size; }, PELLUCID_ERROR_BUFFER_TOO_SMALL,
       "constants.size is " + std::to_string(whole.plan.constantsSize - 1) + "; the plan has " + bytes},
      {[](Slice& s) { s.run(s.indexOf("base level"), 29); }, PELLUCID_ERROR_INVALID_ARGUMENT,
       "constants.mapped has 29 x 1 x 1 groups of \"base level\", which are at most 28 x 1 x 1"},
      {[](Slice& s) { s.run(s.indexOf("probes"), 1, 2, 1); }, PELLUCID_ERROR_INVALID_ARGUMENT,
       "constants.mapped has 1 x 2 x 1 groups of \"probes\""},
      {[](Slice& s) { s.plan.dispatches[s.indexOf("diffuse")].indirectOffset = s.plan.constantsSize - 8; },
       PELLUCID_ERROR_INVALID_ARGUMENT,
       "].indirectOffset is " + std::to_string(whole.plan.constantsSize - 8)},
      {[](Slice& s) { s.plan.dispatchCount = PELLUCID_MAX_DISPATCHES + 1; }, PELLUCID_ERROR_INVALID_ARGUMENT,
       "plan.dispatchCount is 33, more than 32"},
      {[](Slice& s) { s.statistics.structSize = 0; }, PELLUCID_ERROR_VERSION,
       "statistics.structSize is 0; this library writes " + std::to_string(sizeof(PellucidStatistics))},
      {[](Slice& s) { s.statistics.structSize -= 8; }, PELLUCID_ERROR_VERSION, "statistics.structSize is "},
      {[](Slice& s) { s.statistics.structSize += 4; }, PELLUCID_ERROR_VERSION, "statistics.structSize is "},
      {[](Slice& s) { s.statistics.structSize = 4104; }, PELLUCID_ERROR_VERSION, "is 4104"}};
  for (const Case& c : cases) {
    Slice s{Gathered()};
    c.change(s);
    s.statistics.tiles.run = 77;
    EXPECT_EQ(s.read(), c.result) << c.sentence;
    EXPECT_NE(s.sentences.find(c.sentence), std::string::npos) << s.sentences << "is not " << c.sentence;
    EXPECT_EQ(s.statistics.tiles.run, 77u) << c.sentence << ": written all the same";
    // A caller need not listen.
    EXPECT_EQ(pellucidReadStatistics(&s.plan, &s.constants, &s.statistics, nullptr, nullptr), c.result);
  }
  Slice s{Gathered()};
  EXPECT_EQ(pellucidReadStatistics(nullptr, &s.constants, &s.statistics, nullptr, nullptr),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidReadStatistics(&s.plan, nullptr, &s.statistics, nullptr, nullptr),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidReadStatistics(&s.plan, &s.constants, nullptr, nullptr, nullptr),
            PELLUCID_ERROR_INVALID_ARGUMENT);
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
  EXPECT_EQ(newer.known.tiles.most, 28u);
  EXPECT_EQ(newer.known.reserved, 0u);
  EXPECT_EQ(newer.more[0], 0u);
  EXPECT_EQ(newer.more[1], 0u);
}

}  // namespace
