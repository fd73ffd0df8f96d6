// stepBudget over time series: it must reach a setting that fits within a bounded number of frames
// and must not swing between two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <random>

#include "view/frame_budget.h"

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

TEST(Budget, StaysBestWhenItFits) {
  const Series run = simulate(1000, [](int) { return 1.9f; });
  EXPECT_EQ(run.changes, 0);
  EXPECT_EQ(run.last.gatherSamples, kMost);
  EXPECT_EQ(run.last.reuse, 0u);
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

// Whatever the state holds, a light load reaches the best setting and a heavy one the cheapest.
TEST(Budget, DamagedStatesRecover) {
  for (const uint32_t bits : {0u, 1u, 0x7FC00000u, 0x7F800000u, 0xFFFFFFFFu, 0x80000000u}) {
    BudgetState light, heavy;
    for (size_t i = 0; i < sizeof light / 4; ++i)
      std::memcpy(reinterpret_cast<char*>(&light) + 4 * i, &bits, 4);
    heavy = light;
    for (int i = 0; i < 40000; ++i) {
      stepBudget(light, 0.5f, 2);
      stepBudget(heavy, 100, 2);
    }
    BudgetState best;
    EXPECT_EQ(light.gatherSamples, best.gatherSamples) << bits;
    EXPECT_EQ(light.reuse, 0u) << bits;
    EXPECT_EQ(heavy.gatherSamples, 0u) << bits;
  }
}

// Likewise where each field is damaged in its own way, or is not.
TEST(Budget, RandomStatesRecover) {
  std::mt19937 random(19);
  const uint32_t words[] = {0,           1,           2,           3,           30,         4096,
                            0x7FC00000u, 0x7F800000u, 0x3F800000u, 0x80000000u, 0xFFFFFFFFu};
  for (int state = 0; state < 300; ++state) {
    SCOPED_TRACE(state);
    BudgetState light;
    for (size_t i = 0; i < sizeof light / 4; ++i) {
      const uint32_t kind = static_cast<uint32_t>(random()) % 4;
      if (kind == 0) continue;
      const uint32_t word = kind == 1 ? static_cast<uint32_t>(random()) : words[random() % std::size(words)];
      std::memcpy(reinterpret_cast<char*>(&light) + 4 * i, &word, 4);
    }
    BudgetState heavy = light;
    int lightFrames = 0, heavyFrames = 0;
    // Waits of 4096 frames at most: three for the samples, and one for the reuse.
    for (; lightFrames < 20000 && !(light.gatherSamples == kMost && light.reuse == 0); ++lightFrames)
      stepBudget(light, 0.5f, kBudget);
    for (; heavyFrames < 100 && heavy.gatherSamples != 0; ++heavyFrames) stepBudget(heavy, 100, kBudget);
    EXPECT_LT(lightFrames, 20000);
    EXPECT_LE(heavyFrames, kLongestOver + 2) << "as from a state that is whole, after what it lets settle";
  }
}

TEST(Budget, SlowRamps) {
  const Series run =
      simulate(20000, [](int i) { return 0.5f + 7.5f * std::abs(1 - static_cast<float>(i) / 10000); });
  EXPECT_LE(run.changes, 30);
  EXPECT_LE(run.longestOver, kLongestOver);
}

TEST(Budget, WhatNeverFitsStaysCheapest) {
  const Series run = simulate(1000, [](int) { return 100.0f; });
  EXPECT_EQ(run.changes, kReductions);
  EXPECT_EQ(run.last.gatherSamples, 0u);
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
