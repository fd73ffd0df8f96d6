// Which frames of a sequence refresh the light that comes through, decided by BuildPlan alone.
#include <cmath>
#include <numbers>

#include "frame_fixture.h"
#include "plan.h"

namespace {

using pellucid::kCoherentLights;
using pellucid::stateOf;
using pellucid::test::Frame;

struct Sequence : Frame {
  PellucidPlan last{};
  bool first = true;

  explicit Sequence(PellucidReuse reuse) : Frame(0) { frame.options.reuse = reuse; }

  void turnLights(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    for (PellucidLight& l : lights) {
      l.direction[0] = static_cast<float>(std::sin(angle));
      l.direction[2] = static_cast<float>(std::cos(angle));
    }
  }

  // Plans the next frame; true if it refreshes. The plan takes its own predecessor's place.
  bool refreshes() {
    EXPECT_EQ(pellucidBuildPlan(&frame, first ? nullptr : &last, &last), PELLUCID_OK) << problems();
    first = false;
    for (uint32_t i = 0; i < last.skipCount; ++i)
      if (last.skips[i].reason == std::string("reused from an earlier frame")) return false;
    return true;
  }
};

TEST(Reuse, StillFramesRefreshAsTheirKindSays) {
  Sequence none(PELLUCID_REUSE_NONE), alternate(PELLUCID_REUSE_ALTERNATE), coherent(PELLUCID_REUSE_COHERENCE),
      tooMany(PELLUCID_REUSE_COHERENCE);
  tooMany.lights.resize(kCoherentLights + 1, tooMany.lights[0]);
  tooMany.use();
  for (uint32_t i = 0; i < 50; ++i) {
    EXPECT_TRUE(none.refreshes()) << i;
    EXPECT_EQ(alternate.refreshes(), i % 2 == 0) << i;
    EXPECT_EQ(coherent.refreshes(), i == 0) << i;
    EXPECT_EQ(coherent.last.historyAge, i);
    EXPECT_TRUE(tooMany.refreshes()) << "more lights than are followed";
  }
  EXPECT_EQ(stateOf(none.last).history.valid, 0u);
}

// A light that turns half a degree a frame: refreshed exactly when the cosine has moved by more than the
// threshold.
TEST(Reuse, CoherenceOfATurningLight) {
  for (const float threshold : {0.005f, 0.02f}) {
    Sequence s(PELLUCID_REUSE_COHERENCE);
    s.frame.options.coherenceThreshold = threshold;
    double kept = 2;
    for (int i = 0; i < 100; ++i) {
      const double degrees = 20 + 0.5 * i, cosine = std::cos(degrees * std::numbers::pi / 180);
      s.turnLights(degrees);
      const bool expected = std::abs(cosine - kept) > static_cast<double>(threshold);
      EXPECT_EQ(s.refreshes(), expected) << i;
      if (expected) kept = cosine;
    }
  }
}

// With an anchor the history has more rows.
TEST(Reuse, AccumulationBeginsAnewWhereAnAnchorComesOrGoes) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  s.frame.options.gatherSamples = 8;
  s.frame.motion = Frame::view();
  uint32_t age = 0;
  for (const float anchored : {0.0f, 0.0f, 1.0f, 1.0f, 0.0f}) {
    const bool changes = anchored != s.frame.options.anchor[3];
    s.frame.options.anchor[2] = -5;
    s.frame.options.anchor[3] = anchored;
    s.refreshes();
    EXPECT_EQ(s.last.historyAge, changes || age == 0 ? 0 : age) << anchored;
    age = s.last.historyAge + 1;
  }
}

TEST(Reuse, TheCameraTurnsTheCosineToo) {
  Sequence s(PELLUCID_REUSE_COHERENCE);
  EXPECT_TRUE(s.refreshes());
  s.turnLights(30);
  EXPECT_TRUE(s.refreshes());
  // The camera follows by the same angle about the same axis, and so the cosine returns to 1.
  const float c = std::cos(0.5235988f), n = std::sin(0.5235988f);
  const float turned[16] = {c, 0, n, 0, 0, 1, 0, 0, -n, 0, c, 0, 0, 0, 0, 1};
  std::copy(turned, turned + 16, s.frame.viewFromWorld);
  EXPECT_TRUE(s.refreshes());
  EXPECT_NEAR(stateOf(s.last).history.lightDots[0], 1, 1e-6);
  EXPECT_FALSE(s.refreshes());
}

// Kept light is of an image, of lights, and in units of the exposure of its frame.
TEST(Reuse, OtherFramesRefresh) {
  const std::pair<const char*, void (*)(Sequence&)> changes[] = {
      {"nothing", [](Sequence&) {}},
      {"extent", [](Sequence& s) { s.frame.imageExtent[0] = 99; }},
      {"rect", [](Sequence& s) { s.frame.options.renderRect[2] = s.frame.options.renderRect[3] = 20; }},
      {"format", [](Sequence& s) { s.frame.options.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT; }},
      {"exposure", [](Sequence& s) { s.frame.preExposure = 0.5f; }},
      {"one light more",
       [](Sequence& s) {
         s.lights.push_back(s.lights[0]);
         s.use();
       }},
      {"no lights in between", [](Sequence& s) {
         s.frame.lightCount = 0;
         s.refreshes();  // nothing comes through, nothing is kept
         s.use();
       }}};
  for (const auto reuse : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE})
    for (const auto& [name, change] : changes) {
      Sequence s(reuse);
      EXPECT_TRUE(s.refreshes());
      change(s);
      EXPECT_EQ(s.refreshes(), std::string(name) != "nothing") << name;
      if (reuse == PELLUCID_REUSE_COHERENCE) {
        EXPECT_FALSE(s.refreshes()) << name;
      }
    }
}

// The rest of the needs is held by Plan.EveryPlanKeepsTheRules.
TEST(Reuse, TheHistoryIsTheLastNeedAndTheOnlyOneThatPersists) {
  Sequence s(PELLUCID_REUSE_ALTERNATE);
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS + 1];
  uint32_t count = PELLUCID_MAX_TRANSIENTS + 1;
  ASSERT_EQ(pellucidGetImageNeeds(&s.frame, &count, needs), PELLUCID_OK);
  for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(needs[i].persistent, i + 1 == count);
  for (int frame = 0; frame < 2; ++frame) {
    s.refreshes();
    EXPECT_EQ(s.last.dispatches[0].barrierBefore, 1u) << "after the last frame's use of the history";
  }
}

// Probes of two frames lie in the history, which takes other exposures and other lights, and no other extent.
TEST(Reuse, AccumulationNeverReuses) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  s.frame.options.gatherSamples = 8;
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS + 1];
  uint32_t count = PELLUCID_MAX_TRANSIENTS + 1;
  ASSERT_EQ(pellucidGetImageNeeds(&s.frame, &count, needs), PELLUCID_OK);
  ASSERT_TRUE(needs[count - 1].persistent);
  EXPECT_EQ(needs[count - 1].extent[0], 100u);
  EXPECT_EQ(needs[count - 1].extent[1], 2 * 50u);
  for (uint32_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(s.refreshes());
    EXPECT_EQ(s.last.historyAge, i);
    s.frame.preExposure *= 0.5f;
    s.lights[0].intensity *= 2;
  }
  s.frame.imageExtent[0] = 99;
  EXPECT_TRUE(s.refreshes());
  EXPECT_EQ(s.last.historyAge, 0u);
}

// Rows of probes lie elsewhere in the history of the other kind, which then has another size.
TEST(Reuse, ChangesBetweenAccumulationAndReuseBeginAnew) {
  for (const auto other : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE})
    for (const bool toAccumulation : {false, true}) {
      Sequence s(toAccumulation ? other : PELLUCID_REUSE_ACCUMULATE);
      s.frame.options.gatherSamples = 8;
      s.frame.motion = Frame::view();
      for (int i = 0; i < 3; ++i) s.refreshes();
      s.frame.options.reuse = toAccumulation ? PELLUCID_REUSE_ACCUMULATE : other;
      EXPECT_TRUE(s.refreshes());
      EXPECT_EQ(s.last.historyAge, 0u);
    }
}

// Views may come after the plan, and recording then asks for them.
TEST(Reuse, AccumulationBindsMotionThatHasNoViewYet) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  s.frame.options.gatherSamples = 8;
  s.frame.motion = {};
  s.refreshes();
  int bound = 0;
  for (uint32_t i = 0; i < s.last.dispatchCount; ++i)
    for (const PellucidBinding& b : pellucid::test::bindingsOf(s.last, s.last.dispatches[i]))
      bound += b.resource == PELLUCID_RESOURCE_MOTION;
  EXPECT_EQ(bound, 1);
}

// Without a gather there is nothing to average, and the plan says so.
TEST(Reuse, AccumulationNeedsAGather) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  EXPECT_TRUE(s.refreshes());
  EXPECT_EQ(stateOf(s.last).history.valid, 0u);
  EXPECT_EQ(pellucid::test::skipped(s.last, "accumulation"), 1u);
}

TEST(Reuse, HistoryAndMotionMustBeGiven) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  s.frame.options.gatherSamples = 8;
  for (PellucidImage& image : s.frame.transients) image = Frame::view();
  EXPECT_NE(s.problems().find("history has no view"), std::string::npos) << s.problems();
  s.frame.options.history = Frame::view();
  EXPECT_EQ(s.problems().find("motion has no view"), 0u) << s.problems();
  s.frame.motion = Frame::view();
  EXPECT_EQ(s.problems(), "");
  s.frame.motion.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  EXPECT_NE(s.problems().find("motion is in VkImageLayout 0"), std::string::npos) << s.problems();
}

}  // namespace
