// Which frames of a sequence refresh the light that comes through, decided by BuildPlan alone.
#include <cmath>

#include "frame_fixture.h"
#include "plan.h"

namespace {

using pellucid::kCoherentLights;
using pellucid::stateOf;
using pellucid::test::Frame;

bool reuses(const PellucidPlan& plan) {
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].reason == std::string("reused from an earlier frame")) return true;
  return false;
}

struct Sequence : Frame {
  PellucidPlan last{};
  bool first = true;

  explicit Sequence(PellucidReuse reuse, uint32_t shadowImages = 1) : Frame(shadowImages) {
    frame.options.reuse = reuse;
  }

  void turnLights(double degrees) {
    const double angle = degrees * 3.14159265358979 / 180;
    for (PellucidLight& l : lights) {
      l.direction[0] = static_cast<float>(std::sin(angle));
      l.direction[2] = static_cast<float>(std::cos(angle));
    }
  }

  // Plans the next frame; true if it refreshes. The plan takes its own predecessor's place.
  bool refreshes() {
    EXPECT_EQ(pellucidBuildPlan(&frame, first ? nullptr : &last, &last), PELLUCID_OK) << problems();
    first = false;
    return !reuses(last);
  }
};

TEST(Reuse, NoneNeverReuses) {
  Sequence s(PELLUCID_REUSE_NONE);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(s.refreshes());
  EXPECT_EQ(stateOf(s.last).history.valid, 0u);
}

// Kept light is in units of the exposure of its frame.
TEST(Reuse, AnotherPreExposureRefreshes) {
  Sequence s(PELLUCID_REUSE_COHERENCE);
  EXPECT_TRUE(s.refreshes());
  EXPECT_FALSE(s.refreshes());
  s.frame.preExposure = 0.5f;
  EXPECT_TRUE(s.refreshes());
  EXPECT_FALSE(s.refreshes());
}

TEST(Reuse, AlternateRefreshesEverySecondFrame) {
  Sequence s(PELLUCID_REUSE_ALTERNATE);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(s.refreshes(), i % 2 == 0) << i;
}

TEST(Reuse, CoherenceOfAStillLightRefreshesOnce) {
  Sequence s(PELLUCID_REUSE_COHERENCE);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(s.refreshes(), i == 0) << i;
  EXPECT_EQ(s.last.historyAge, 49u);
}

// A light that turns half a degree a frame: refreshed exactly when the cosine has moved by more than the
// threshold.
TEST(Reuse, CoherenceOfATurningLight) {
  for (const float threshold : {0.005f, 0.02f}) {
    Sequence s(PELLUCID_REUSE_COHERENCE);
    s.frame.options.coherenceThreshold = threshold;
    double kept = 2;
    int refreshed = 0;
    for (int i = 0; i < 100; ++i) {
      const double degrees = 20 + 0.5 * i, cosine = std::cos(degrees * 3.14159265358979 / 180);
      s.turnLights(degrees);
      const bool expected = std::abs(cosine - kept) > static_cast<double>(threshold);
      EXPECT_EQ(s.refreshes(), expected) << i;
      if (expected) kept = cosine;
      refreshed += expected;
    }
    // 20 to 69.5 degrees is .59 of cosine: at most one refresh a threshold.
    EXPECT_LE(refreshed, 1 + 0.59 / static_cast<double>(threshold));
    EXPECT_GE(refreshed, 0.59 / static_cast<double>(threshold) / 4);
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

TEST(Reuse, AnotherImageOrOtherLightsRefresh) {
  for (const auto reuse : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE}) {
    const auto refreshesAfter = [&](auto change) {
      Sequence s(reuse);
      EXPECT_TRUE(s.refreshes());
      change(s);
      return s.refreshes();
    };
    EXPECT_FALSE(refreshesAfter([](Sequence&) {}));
    EXPECT_TRUE(refreshesAfter([](Sequence& s) { s.frame.imageExtent[0] = 99; }));
    EXPECT_TRUE(refreshesAfter(
        [](Sequence& s) { s.frame.options.renderRect[2] = s.frame.options.renderRect[3] = 20; }));
    EXPECT_TRUE(
        refreshesAfter([](Sequence& s) { s.frame.options.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT; }));
    EXPECT_TRUE(refreshesAfter([](Sequence& s) {
      s.lights.push_back(s.lights[0]);
      s.use();
    }));
    EXPECT_TRUE(refreshesAfter([](Sequence& s) {
      s.frame.lightCount = 0;
      s.refreshes();  // nothing comes through, nothing is kept
      s.use();
    }));
  }
}

TEST(Reuse, MoreLightsThanAreFollowedRefreshEveryFrame) {
  Sequence s(PELLUCID_REUSE_COHERENCE);
  s.lights.resize(kCoherentLights + 1, s.lights[0]);
  s.use();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(s.refreshes());
}

// The needs hold for frames that refresh, with several fused dispatches, and for those that reuse.
TEST(Reuse, ImageNeedsCoverBothKindsOfFrame) {
  for (const uint32_t images : {1u, 20u})
    for (const uint32_t features : {1u, 3u}) {
      Sequence s(PELLUCID_REUSE_ALTERNATE, images);
      s.frame.options.features = features;
      PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
      uint32_t count = PELLUCID_MAX_TRANSIENTS;
      ASSERT_EQ(pellucidGetImageNeeds(&s.frame, &count, needs), PELLUCID_OK);
      ASSERT_EQ(count,
                features == 3 ? 6u : 1u);  // a color, the pyramid in three, words of blocks, the history
      for (uint32_t i = 0; i < count; ++i) EXPECT_EQ(needs[i].persistent, i + 1 == count);
      for (int frame = 0; frame < 2; ++frame) {
        s.refreshes();
        EXPECT_EQ(s.last.dispatches[0].barrierBefore, 1u) << "after the last frame's use of the history";
        for (uint32_t d = 0; d < s.last.dispatchCount; ++d)
          for (const PellucidBinding& b : pellucid::test::bindingsOf(s.last, s.last.dispatches[d])) {
            const uint32_t resource = b.resource;
            if (resource < PELLUCID_RESOURCE_TRANSIENT0 || resource >= PELLUCID_RESOURCE_HISTORY) continue;
            const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
            ASSERT_LT(transient + 1, count);
            EXPECT_GE(d, needs[transient].firstDispatch);
            EXPECT_LE(d, needs[transient].lastDispatch);
          }
      }
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

// Without a gather there is nothing to average, and the plan says so.
TEST(Reuse, AccumulationNeedsAGather) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  EXPECT_TRUE(s.refreshes());
  EXPECT_EQ(stateOf(s.last).history.valid, 0u);
  bool said = false;
  for (uint32_t i = 0; i < s.last.skipCount; ++i) said = said || s.last.skips[i].what == std::string("accumulation");
  EXPECT_TRUE(said);
}

TEST(Reuse, HistoryMustBeGiven) {
  Sequence s(PELLUCID_REUSE_ALTERNATE);
  s.frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY;
  EXPECT_NE(s.problems().find("history has no view"), std::string::npos) << s.problems();
  s.frame.options.history = Frame::view();
  EXPECT_EQ(s.problems(), "");
}

TEST(Reuse, AccumulationNeedsMotion) {
  Sequence s(PELLUCID_REUSE_ACCUMULATE);
  s.frame.options.gatherSamples = 8;
  s.frame.options.history = Frame::view();
  for (PellucidImage& image : s.frame.transients) image = Frame::view();
  EXPECT_EQ(s.problems(), "motion has no view, but reuse ACCUMULATE needs it\n");
  s.frame.motion = Frame::view();
  EXPECT_EQ(s.problems(), "");
  s.frame.motion.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  EXPECT_NE(s.problems().find("motion is in VkImageLayout 0"), std::string::npos) << s.problems();
}

}  // namespace
