// What a plan does with frame.quality, targetError and nearestDistance.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "diffusion_error_table.h"
#include "frame_error_table.h"
#include "frame_fixture.h"
#include "shared/pellucid_shared.h"

namespace {

using pellucid::kErrorRadii;
using pellucid::kFrameError;
using pellucid::kWorstError;
using pellucid::test::Frame;

constexpr uint32_t kQualities = 3;

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

uint32_t reductions(const PellucidPlan& plan) {
  return static_cast<uint32_t>(
      std::count_if(plan.dispatches, plan.dispatches + plan.dispatchCount,
                    [](const PellucidDispatch& d) { return d.name == std::string("downsample"); }));
}

// A pixel of the fixture's camera, 100 x 50 pixels over 2 p x 2 p mm at distance p, is 2 p / 100 mm at its
// shorter side; the material's radius is 5 mm.
TEST(Quality, RadiusIsProjected) {
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

TEST(Quality, OrthographicRadiusNeedsNoDistance) {
  Frame f;
  const float projection[16] = {0.1f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
  std::copy(projection, projection + 16, f.frame.clipFromView);
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 25);  // 20 mm over 100 pixels
  f.frame.nearestDistance = 7;
  EXPECT_FLOAT_EQ(f.plan().largestRadius, 25);
}

// The widest Gaussian of the fixture's material has a deviation of 1.41 mm.
TEST(Quality, SmallRadiiDropLevels) {
  Frame f;
  const auto coarsest = [](const PellucidPlan& plan) { return find(plan, "upsample")->pushConstants[0]; };
  EXPECT_EQ(coarsest(f.plan()), 7u) << "not known";
  struct Row {
    float distance;
    uint32_t coarsest;
  };
  // 23.6, 21.4, 5.9, 5.4, .07 pixels
  for (const Row& row : {Row{3, 7}, {3.3f, 5}, {12, 5}, {13, 3}, {1000, 3}})
    for (const uint32_t quality : {0u, 1u, 2u}) {
      f.frame.nearestDistance = row.distance;
      f.frame.quality = quality;
      const PellucidPlan plan = f.plan();
      // Upsampling makes levels 6 and 7.
      EXPECT_EQ(reductions(plan), row.coarsest == 3 ? 1u : 2u) << row.distance;
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
TEST(Quality, ImageNeedsDoNotDependOnTheDistance) {
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

TEST(Quality, RadiiBeyondThePyramidAreReported) {
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

TEST(Quality, ChoosesTheLastPass) {
  Frame f;
  EXPECT_EQ(f.plan().quality, 1u) << "default";
  for (uint32_t quality = 0; quality < kQualities; ++quality) {
    f.frame.quality = quality;
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(plan.quality, quality);
    EXPECT_STREQ(pellucidPipelineName(find(plan, "diffuse")->pipeline),
                 quality == 0 ? "diffuse_coarse" : "diffuse");
  }
}

// Samples and points of the gather, unless single fields say how many.
TEST(Quality, ChoosesTheGather) {
  Frame f(1);
  f.frame.gatherSamples = PELLUCID_GATHER_BY_QUALITY;
  f.frame.imageExtent[0] = 1920;
  f.frame.imageExtent[1] = 1080;
  const uint32_t samples[] = {0, 8, 16}, spacing[] = {0, 4, 2};
  for (uint32_t quality = 0; quality <= 2; ++quality) {
    f.frame.quality = quality;
    const PellucidPlan plan = f.plan();
    const PellucidDispatch* points = find(plan, "probes");
    ASSERT_EQ(points != nullptr, quality > 0);
    if (!points) continue;
    EXPECT_EQ(points->pushConstants[3], samples[quality]);
    EXPECT_EQ(points->pushConstants[0], spacing[quality]);
    EXPECT_EQ(skipped(plan, "gather"), 0u);
  }
  f.frame.gatherSpacing = 1;
  EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], 1u);
  f.frame.gatherSamples = 64;
  EXPECT_EQ(find(f.plan(), "probes")->pushConstants[3], 64u);
  f.frame.gatherSamples = 0;
  EXPECT_EQ(find(f.plan(), "probes"), nullptr);
  EXPECT_EQ(skipped(f.plan(), "gather"), 0u) << "nobody asked for one";
}

// Without the translucency there is nothing to gather, and the diffusion adds nothing.
TEST(Quality, GathersNothingWithoutTranslucency) {
  Frame f(1);
  f.frame.imageExtent[0] = 1920;
  f.frame.imageExtent[1] = 1080;
  f.frame.features = PELLUCID_FEATURE_DIFFUSION;
  const auto pipeline = [&] { return find(f.plan(), "diffuse")->pipeline; };
  const uint32_t alone = pipeline();
  EXPECT_STREQ(pellucidPipelineName(alone), "diffuse");
  for (const uint32_t samples : {8u, PELLUCID_GATHER_BY_QUALITY}) {
    f.frame.gatherSamples = samples;
    EXPECT_EQ(pipeline(), alone);
    EXPECT_EQ(find(f.plan(), "probes"), nullptr);
  }
}

// The plan leaves out a gather that a frame cannot have, and says why.
TEST(Quality, SaysWhyNothingIsGathered) {
  Frame f(1);
  f.frame.gatherSamples = PELLUCID_GATHER_BY_QUALITY;
  f.frame.thicknessSource = PELLUCID_THICKNESS_CAMERA;
  EXPECT_EQ(find(f.plan(), "probes"), nullptr);
  EXPECT_EQ(skipped(f.plan(), "gather"), 1u);
  f.frame.thicknessSource = PELLUCID_THICKNESS_LIGHT;
  const auto skips = [&](auto PellucidThesisOptions::*field, auto value) {
    const auto before = std::exchange(f.thesis.*field, value);
    EXPECT_EQ(find(f.plan(), "probes"), nullptr);
    EXPECT_EQ(skipped(f.plan(), "gather"), 1u);
    f.thesis.*field = before;
  };
  skips(&PellucidThesisOptions::angleModel, PELLUCID_ANGLE_COSINE);
  skips(&PellucidThesisOptions::constantViewDirection, 1u);
  skips(&PellucidThesisOptions::minimumDot, -0.1f);
  skips(&PellucidThesisOptions::maximumThickness, 10.0f);
  EXPECT_NE(find(f.plan(), "probes"), nullptr);
  f.material.transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
  f.material.transmittance[0][0] = f.material.transmittance[1][0] = f.material.transmittance[2][0] = 4;
  EXPECT_EQ(find(f.plan(), "probes"), nullptr);
  EXPECT_EQ(skipped(f.plan(), "gather"), 1u);
  f.frame.quality = 0;
  EXPECT_EQ(skipped(f.plan(), "gather"), 0u);
}

// Against the table: the least quality that is below the target at every radius up to the frame's.
TEST(Quality, TargetErrorChoosesTheLeastThatHolds) {
  Frame f;
  f.frame.features = PELLUCID_FEATURE_DIFFUSION;
  f.frame.quality = 1;
  uint32_t chosen[kQualities] = {}, none = 0;
  for (const float radius : {0.0f, 0.4f, 0.5f, 1.9f, 7.0f, 30.0f, 128.0f, 400.0f}) {
    // 5 mm are 250 / p pixels. 0: not known, as good as the largest.
    f.frame.nearestDistance = radius > 0 ? 250 / radius * 1.0001f : 0;
    for (const float target : {1e-5f, 3e-4f, 0.007f, 0.02f, 0.025f, 0.03f, 0.04f, 0.05f, 0.07f, 0.5f}) {
      f.frame.targetError = target;
      uint32_t expected = kQualities;
      for (uint32_t q = 0; q < kQualities && expected == kQualities; ++q) {
        bool holds = true;
        for (size_t i = 0; i < std::size(kErrorRadii); ++i) {
          const bool reached = radius == 0 || i == 0 || kErrorRadii[i - 1] < radius;
          holds = holds && (!reached || kWorstError[q == 0 ? 0 : 1][i] < target);
        }
        if (holds) expected = q;
      }
      const bool found = expected < kQualities;
      const PellucidPlan plan = f.plan();
      EXPECT_EQ(plan.quality, found ? expected : kQualities - 1) << radius << " pixels, " << target;
      EXPECT_EQ(skipped(plan, "targetError"), found ? 0u : 1u) << radius << ", " << target;
      ++(found ? chosen[expected] : none);
    }
  }
  EXPECT_GT(chosen[0], 0u);
  EXPECT_GT(chosen[1], 0u);
  EXPECT_EQ(chosen[2], 0u) << "its diffusion is that of quality 1";
  EXPECT_GT(none, 0u);
}

// With light that comes through, the target is an error of the whole frame.
TEST(Quality, TargetErrorOfWholeFramesChoosesTheGather) {
  Frame f;
  f.frame.gatherSamples = PELLUCID_GATHER_BY_QUALITY;
  const auto chosen = [&](float target) {
    f.frame.targetError = target;
    const PellucidPlan plan = f.plan();
    return std::pair(plan.quality, plan.gatherSamples);
  };
  EXPECT_EQ(chosen(kFrameError[0] * 1.01f), std::pair(0u, 0u));
  EXPECT_EQ(chosen(kFrameError[0]), std::pair(1u, 8u)) << "an error stays below its target";
  EXPECT_EQ(chosen(kFrameError[1]), std::pair(2u, 16u));
  EXPECT_EQ(chosen(kFrameError[2]), std::pair(2u, 16u)) << "no quality is that exact";
  EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
  f.frame.gatherSamples = 4;
  EXPECT_EQ(chosen(kFrameError[0]), std::pair(0u, 4u)) << "samples of the caller's";
  f.frame.gatherSamples = 0;
  EXPECT_EQ(chosen(kFrameError[0] * 1.01f), std::pair(0u, 0u));
  EXPECT_EQ(chosen(kFrameError[0]), std::pair(2u, 0u));
}

// One thickness a pixel has one error at every quality.
TEST(Quality, TargetErrorKnowsWhereNothingIsGathered) {
  Frame f;
  f.frame.gatherSamples = PELLUCID_GATHER_BY_QUALITY;
  f.frame.targetError = kFrameError[1] * 1.01f;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 0u);
  f.thesis.angleModel = PELLUCID_ANGLE_COSINE;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
  f.thesis.angleModel = PELLUCID_ANGLE_NORMAL;
  for (PellucidLight& light : f.lights) light.shadowMapCount = 0;
  EXPECT_EQ(skipped(f.plan(), "targetError"), 1u);
}

TEST(Quality, IsInThePlansText) {
  Frame f;
  f.frame.nearestDistance = 50;
  const PellucidPlan plan = f.plan();
  char text[65536];
  size_t size = sizeof text;
  ASSERT_EQ(pellucidPlanToJson(&plan, text, &size), PELLUCID_OK);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("quality"), 1);
  EXPECT_NEAR(json.at("largestRadius").get<double>(), 5, 1e-5);
}

}  // namespace
