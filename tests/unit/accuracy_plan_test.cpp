// Plans by options.gatherSamples and nearestDistance.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "frame_fixture.h"

namespace {

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
  f.frame.options.nearestDistance = 50;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 5);
  f.frame.options.nearestDistance = 25;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 10);
  f.frame.metersPerUnit = 0.01f;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 1);
  f.material.radius[2] = 15;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 3) << "the widest channel";
  f.frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY;
  EXPECT_EQ(f.plan().largestRadius, 0) << "nothing diffuses";
}

TEST(AccuracyPlan, OrthographicRadiusNeedsNoDistance) {
  Frame f;
  const float projection[16] = {0.1f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
  std::copy(projection, projection + 16, f.frame.clipFromView);
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 25);  // 20 mm over 100 pixels
  f.frame.options.nearestDistance = 7;
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
    f.frame.options.nearestDistance = row.distance;
    const PellucidPlan plan = f.plan();
    const std::vector<std::string> all = names(plan);
    // Two levels each, from level 1 on.
    EXPECT_EQ(std::count(all.begin(), all.end(), "downsample"), (row.coarsest - 1) / 2) << row.distance;
    EXPECT_EQ(coarsest(plan), row.coarsest) << row.distance;
  }
  f.frame.options.nearestDistance = 13;
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
  f.frame.options.nearestDistance = 50;
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
  f.frame.options.nearestDistance = 1;  // 50 pixels a mm; level 7 is 97.8 pixels
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 1u);
  f.frame.options.nearestDistance = 0.7f;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 2u);
  f.frame.options.nearestDistance = 3;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 0u);
  f.frame.options.nearestDistance = 1e-38f;
  EXPECT_TRUE(std::isfinite(f.plan().largestRadius));
  f.frame.options.nearestDistance = 0;
  EXPECT_EQ(skipped(f.plan(), "diffusion radius"), 0u) << "not known";
}

// A frame whose samples are the default's; its 100 x 50 pixels have a probe each.
struct Gathered : Frame {
  Gathered() { frame.options.gatherSamples = 8; }
};

TEST(AccuracyPlan, GathersTheFramesSamples) {
  PellucidFrame fresh;
  pellucidInitFrame(&fresh);
  EXPECT_EQ(fresh.options.gatherSamples, 8u);
  for (const uint32_t samples : {0u, 4u, 8u, 16u, 64u}) {
    Frame f;
    f.frame.options.gatherSamples = samples;
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
      f.frame.options.gatherSamples = samples;
      f.frame.imageExtent[0] = row.width;
      f.frame.imageExtent[1] = row.height;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], row.spacing) << row.height << " rows";
      f.frame.options.gatherSpacing = 1;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], 1u);
    }
}

// The plan leaves out a gather that a frame cannot have, and says why.
TEST(AccuracyPlan, SaysWhyNothingIsGathered) {
  struct Case {
    const char* name;
    void (*change)(Frame&);
  };
  const Case cases[] = {{"thickness", [](Frame& f) { f.frame.options.cameraThickness = 1; }},
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
    f.frame.options.gatherSamples = 0;
    EXPECT_EQ(skipped(f.plan(), "gather"), 0u) << "nobody asked for one";
  }
}

}  // namespace
