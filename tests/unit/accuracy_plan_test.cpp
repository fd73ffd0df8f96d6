// Plans by frame.gatherSamples, targetError and nearestDistance.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "diffusion_error_table.h"
#include "frame_error_table.h"
#include "frame_fixture.h"

namespace {

using pellucid::kErrorRadii;
using pellucid::kFrameError;
using pellucid::kWorstError;
using pellucid::test::Frame;
using pellucid::test::names;

uint32_t skipped(const PellucidPlan& plan, const std::string& what) {
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].what == what) return plan.skips[i].count;
  return 0;
}

const PellucidDispatch* find(const PellucidPlan& plan, const std::string& name) {
  for (uint32_t i = 0; i < plan.dispatchCount; ++i)
    if (plan.dispatches[i].name == name) return &plan.dispatches[i];
  return nullptr;
}

// A pixel of the fixture's camera, 100 x 50 pixels over 2 p x 2 p mm at distance p, is 2 p / 100 mm at its
// shorter side; the material's radius is 5 mm.
TEST(AccuracyPlan, RadiusIsProjected) {
  Frame f;
  EXPECT_EQ(f.plan().largestRadius, 0) << "a perspective camera without a distance";
  f.frame.nearestDistance = 50;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 5);
  f.frame.nearestDistance = 25;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 10);
  f.frame.metersPerUnit = 0.01f;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 1);
  f.material.radius[2] = 15;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 3) << "the widest channel";
  f.frame.features = PELLUCID_FEATURE_TRANSLUCENCY;
  EXPECT_EQ(f.plan().largestRadius, 0) << "nothing diffuses";
}

TEST(AccuracyPlan, OrthographicRadiusNeedsNoDistance) {
  Frame f;
  const float projection[16] = {0.1f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
  std::copy(projection, projection + 16, f.frame.clipFromView);
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 25);  // 20 mm over 100 pixels
  f.frame.nearestDistance = 7;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 25);
}

// The widest Gaussian of the fixture's material has a deviation of 1.41 mm.
TEST(AccuracyPlan, SmallRadiiDropLevels) {
  Frame f;
  const auto coarsest = [](const PellucidPlan& plan) { return find(plan, "upsample")->pushConstants[0]; };
  EXPECT_EQ(coarsest(f.plan()), 7u) << "not known";
  struct Row {
    float distance;
    uint32_t coarsest;
  };
  // 23.6, 21.4, 5.9, 5.4, .07 pixels
  for (const Row& row : {Row{3, 7}, {3.3f, 5}, {12, 5}, {13, 3}, {1000, 3}}) {
    f.frame.nearestDistance = row.distance;
    const PellucidPlan plan = f.plan();
    const std::vector<std::string> all = names(plan);
    // Two levels each, from level 1 on.
    EXPECT_EQ(std::count(all.begin(), all.end(), "downsample"), (row.coarsest - 1) / 2) << row.distance;
    EXPECT_EQ(coarsest(plan), row.coarsest) << row.distance;
  }
  f.frame.nearestDistance = 13;
  f.material.gaussianVariance[1][0] = 4;  // 7.7 pixels
  EXPECT_EQ(coarsest(f.plan()), 5u) << "any Gaussian of any channel";
  f.material.gaussianWeight[1][0] = 0;
  f.material.gaussianWeight[1][1] = 1;
  EXPECT_EQ(coarsest(f.plan()), 3u) << "that has a weight";
}

// The images that the caller creates do not follow a distance that changes every frame.
TEST(AccuracyPlan, ImageNeedsDoNotDependOnTheDistance) {
  Frame f;
  PellucidImageNeed unknown[PELLUCID_MAX_TRANSIENTS], known[PELLUCID_MAX_TRANSIENTS];
  uint32_t count = PELLUCID_MAX_TRANSIENTS, same = PELLUCID_MAX_TRANSIENTS;
  ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &count, unknown), PELLUCID_OK);
  f.frame.nearestDistance = 50;
  ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &same, known), PELLUCID_OK);
  ASSERT_EQ(count, same);
  for (uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(unknown[i].extent[0], known[i].extent[0]);
    EXPECT_EQ(unknown[i].extent[1], known[i].extent[1]);
  }
}

TEST(AccuracyPlan, RadiiBeyondThePyramidAreReported) {
  Frame f;
  PellucidMaterial materials[3] = {f.material, f.material, f.material};
  materials[1].gaussianVariance[0][1] = 16;  // 4 mm
  materials[2].gaussianCount = 0;
  f.frame.materials = materials;
  f.frame.materialCount = 3;
  f.frame.nearestDistance = 1;  // 50 pixels a mm; level 7 is 97.8 pixels
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 1u);
  f.frame.nearestDistance = 0.7f;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 2u);
  f.frame.nearestDistance = 3;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 0u);
  f.frame.nearestDistance = 1e-38f;
  EXPECT_TRUE(std::isfinite(f.plan().largestRadius));
  f.frame.nearestDistance = 0;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 0u) << "not known";
}

// A frame whose samples are the default's; its 100 x 50 pixels have a probe each.
struct Gathered : Frame {
  Gathered() { frame.gatherSamples = 8; }
};

TEST(AccuracyPlan, GathersTheFramesSamples) {
  PellucidFrame fresh;
  pellucidInitFrame(&fresh);
  EXPECT_EQ(fresh.gatherSamples, 8u);
  for (const uint32_t samples : {0u, 4u, 8u, 16u, 64u}) {
    Frame f;
    f.frame.gatherSamples = samples;
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(plan.gatherSamples, samples);
    EXPECT_EQ(find(plan, "probes") != nullptr, samples > 0);
    EXPECT_EQ(skipped(plan, "gather"), 0u) << "nobody asked for more";
  }
}

// As large images' probes would cost the most, they lie farther apart, however many samples they take.
TEST(AccuracyPlan, ProbesLieApartByTheImagesSize) {
  struct Row {
    uint32_t width, height, spacing;
  };
  for (const Row& row : {Row{1024, 512, 1}, {1024, 513, 2}, {1024, 1024, 2}, {1024, 1025, 4}})
    for (const uint32_t samples : {4u, 16u}) {
      Frame f;
      f.frame.gatherSamples = samples;
      f.frame.imageExtent[0] = row.width;
      f.frame.imageExtent[1] = row.height;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], row.spacing) << row.height << " rows";
      f.frame.gatherSpacing = 1;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], 1u);
    }
}

// The plan leaves out a gather that a frame cannot have, and says why.
TEST(AccuracyPlan, SaysWhyNothingIsGathered) {
  struct Case {
    const char* name;
    void (*change)(Frame&);
  };
  const Case cases[] = {{"thickness", [](Frame& f) { f.frame.thicknessSource = PELLUCID_THICKNESS_CAMERA; }},
                        {"mark bit", [](Frame& f) { f.thesis.materialMarkBit = 128; }},
                        {"angle", [](Frame& f) { f.thesis.angleModel = PELLUCID_ANGLE_COSINE; }},
                        {"view", [](Frame& f) { f.thesis.constantViewDirection = 1; }},
                        {"minimum dot", [](Frame& f) { f.thesis.minimumDot = -0.1f; }},
                        {"thickest", [](Frame& f) { f.thesis.maximumThickness = 10; }},
                        {"model", [](Frame& f) {
                           f.material.transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
                           for (auto& channel : f.material.transmittance) channel[0] = 4;
                         }}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Gathered f;
    ASSERT_NE(find(f.plan(), "probes"), nullptr);
    c.change(f);
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(find(plan, "probes"), nullptr);
    EXPECT_EQ(find(plan, "entry points"), nullptr);
    EXPECT_EQ(plan.gatherSamples, 0u);
    EXPECT_EQ(names(plan)[0], "translucency") << "one thickness a pixel";
    EXPECT_EQ(skipped(plan, "gather"), 1u);
    f.frame.gatherSamples = 0;
    EXPECT_EQ(skipped(f.plan(), "gather"), 0u) << "nobody asked for one";
  }
}

// Against the table, without lights: the diffusion's error at every radius up to the frame's.
TEST(AccuracyPlan, TargetErrorOfTheDiffusionIsHeldOrReported) {
  Frame f;
  f.frame.features = PELLUCID_FEATURE_DIFFUSION;
  uint32_t held = 0, missed = 0;
  for (const float radius : {0.0f, 0.4f, 0.5f, 1.9f, 7.0f, 30.0f, 128.0f, 400.0f}) {
    // 5 mm are 250 / p pixels. 0: not known, as good as the largest.
    f.frame.nearestDistance = radius > 0 ? 250 / radius * 1.0001f : 0;
    for (const float target : {1e-5f, 3e-4f, 0.007f, 0.02f, 0.025f, 0.03f, 0.04f, 0.05f, 0.07f, 0.5f}) {
      f.frame.targetError = target;
      bool holds = true;
      for (size_t i = 0; i < std::size(kErrorRadii); ++i) {
        const bool reached = radius == 0 || i == 0 || kErrorRadii[i - 1] < radius;
        holds = holds && (!reached || kWorstError[i] < target);
      }
      EXPECT_EQ(skipped(f.plan(), "targetError"), holds ? 0u : 1u) << radius << " pixels, " << target;
      ++(holds ? held : missed);
    }
  }
  EXPECT_GT(held, 0u);
  EXPECT_GT(missed, 0u);
}

// With light that comes through, the target is an error of the whole frame.
TEST(AccuracyPlan, TargetErrorOfWholeFramesChoosesTheSamples) {
  // In place of any number of the frame's.
  for (const uint32_t samples : {0u, 4u, 64u}) {
    Frame f;
    f.frame.gatherSamples = samples;
    const auto chosen = [&](float target) {
      f.frame.targetError = target;
      return f.plan().gatherSamples;
    };
    EXPECT_EQ(chosen(kFrameError[0] * 1.01f), 0u);
    EXPECT_EQ(chosen(kFrameError[0]), 8u) << "an error stays below its target";
    EXPECT_EQ(chosen(kFrameError[1]), 16u);
    EXPECT_EQ(skipped(f.plan(), "targetError"), 0u);
    EXPECT_EQ(chosen(kFrameError[2]), 16u) << "no number of samples is that exact";
    EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
  }
}

TEST(AccuracyPlan, TargetErrorKnowsWhereNothingIsGathered) {
  Frame f;
  f.frame.targetError = kFrameError[1] * 1.01f;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 0u);
  f.thesis.angleModel = PELLUCID_ANGLE_COSINE;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
  f.thesis.angleModel = PELLUCID_ANGLE_NORMAL;
  for (PellucidLight& light : f.lights) light.shadowMapCount = 0;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
}

TEST(AccuracyPlan, IsInThePlansText) {
  Gathered f;
  f.frame.nearestDistance = 50;
  const PellucidPlan plan = f.plan();
  char text[65536];
  size_t size = sizeof text;
  ASSERT_EQ(pellucidPlanToJson(&plan, text, &size), PELLUCID_OK);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("gatherSamples"), 8);
  EXPECT_NEAR(json.at("largestRadius").get<double>(), 5, 1e-5);
}

}  // namespace
