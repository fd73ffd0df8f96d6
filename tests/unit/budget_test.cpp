// stepBudget over time series: it must reach a setting that fits within a bounded number of frames
// and must not swing between two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <random>

#include "view/cost.h"

namespace {

using pellucid::harness::BudgetState;
using pellucid::harness::stepBudget;

constexpr float kBudget = 2;
constexpr uint32_t kMost = 16, kSamples[] = {kMost, 8, 4, 0};
// Reuse and three fewer samples, each after 3 frames over the budget and 2 that are not looked at.
constexpr int kReductions = static_cast<int>(std::size(kSamples)), kLongestOver = kReductions * (3 + 2);

// What a setting costs of the best one's time.
float share(const BudgetState& s) {
  const float shares[] = {1, 0.6f, 0.5f, 0.3f};
  const uint32_t* found = std::find(std::begin(kSamples), std::end(kSamples), s.gatherSamples);
  EXPECT_NE(found, std::end(kSamples)) << s.gatherSamples;
  return shares[found - kSamples] * (s.reuse ? 0.7f : 1.0f);
}

struct Series {
  int changes = 0;
  int longestOver = 0;  // frames on end above the budget
  BudgetState last;
};

// `load(frame)`: the time of the best setting, ms.
Series simulate(int frames, const std::function<float(int)>& load) {
  Series run;
  int over = 0;
  for (int i = 0; i < frames; ++i) {
    const BudgetState before = run.last;
    const float measured = load(i) * share(before);
    over = measured > kBudget ? over + 1 : 0;
    run.longestOver = std::max(run.longestOver, over);
    stepBudget(run.last, measured, kBudget);
    run.changes += run.last.gatherSamples != before.gatherSamples || run.last.reuse != before.reuse;
  }
  return run;
}

TEST(Budget, StepDownAndBack) {
  const Series run = simulate(3000, [](int i) { return i >= 500 && i < 1500 ? 8.0f : 1.0f; });
  EXPECT_LE(run.longestOver, kLongestOver);
  EXPECT_EQ(run.last.gatherSamples, kMost) << "back at the best when the load is gone";
  EXPECT_EQ(run.last.reuse, 0u);
  EXPECT_LE(run.changes, 20);
}

TEST(Budget, SpikesChangeNothing) {
  const Series run = simulate(5000, [](int i) { return i % 50 < 2 ? 20.0f : 1.5f; });
  EXPECT_EQ(run.changes, 0);
}

// Every constant load, and so every gap between two settings.
TEST(Budget, NoOscillationUnderConstantLoad) {
  for (float load = 0.5f; load < 9; load *= 1.01f) {
    const Series run = simulate(20000, [&](int) { return load; });
    // The reductions, and failed raises at waits of 30, 60, .. 4096 frames: fewer than 10 pairs.
    EXPECT_LE(run.changes, kReductions + 20) << load;
    EXPECT_LE(run.longestOver, kLongestOver) << load;
  }
}

TEST(Budget, NoiseDoesNotSwing) {
  for (float load : {1.5f, 1.9f, 2.0f, 2.5f, 3.0f, 4.0f, 6.0f}) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(1, 0.1f);
    const Series run = simulate(20000, [&](int) { return load * noise(random); });
    EXPECT_LE(run.changes, 60) << load;  // 3 in 1000 frames
  }
}

TEST(Budget, BadTimesAreIgnored) {
  BudgetState state;
  for (const float bad : {NAN, INFINITY, -1.0f})
    for (int i = 0; i < 10; ++i) stepBudget(state, bad, kBudget);
  for (const float bad : {NAN, 0.0f, -1.0f})
    for (int i = 0; i < 10; ++i) stepBudget(state, 100, bad);
  EXPECT_EQ(state.gatherSamples, kMost);
  EXPECT_EQ(state.overFrames, 0u);
}

}  // namespace
