// What a plan does with frame.quality, targetError and nearestDistance.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "diffusion_error_table.h"
#include "frame_fixture.h"
#include "shared/pellucid_shared.h"

namespace {

using pellucid::kErrorRadii;
using pellucid::kWorstError;
using pellucid::test::Frame;

constexpr uint32_t kQualities = std::size(kWorstError);

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
                    [](const PellucidDispatch& d) { return d.name == std::string("reduce"); }));
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
  const auto coarsest = [](const PellucidPlan& plan) { return find(plan, "resolve")->pushConstants[0]; };
  EXPECT_EQ(coarsest(f.plan()), 7u) << "not known";
  struct Row {
    float distance;
    uint32_t coarsest;
  };
  // 23.6, 21.4, 5.9, 5.4, .07 pixels
  for (const Row& row : {Row{3, 7}, {3.3f, 5}, {12, 5}, {13, 3}, {1000, 3}})
    for (const uint32_t quality : {1u, 2u, 3u}) {
      f.frame.nearestDistance = row.distance;
      f.frame.quality = quality;
      f.frame.normal = Frame::view();
      const PellucidPlan plan = f.plan();
      // Levels 4 and 5 are made beside 2 and 3, levels 6 and 7 by the resolve, unless edges are summed.
      const bool makesLast = row.coarsest == 7 && quality < 3;
      const uint32_t reduce[] = {PELLUCID_PIPELINE_REDUCE_LEVELS, PELLUCID_PIPELINE_REDUCE_FOR_SUMS,
                                 PELLUCID_PIPELINE_REDUCE_FOR_EDGES};
      EXPECT_EQ(find(plan, "reduce")->pipeline, reduce[quality - 1]);
      const uint32_t last[] = {PELLUCID_PIPELINE_REDUCE_AND_RESOLVE,
                               PELLUCID_PIPELINE_REDUCE_RESOLVE_AND_SUM_16F};
      const uint32_t resolve[] = {PELLUCID_PIPELINE_RESOLVE_LEVELS, PELLUCID_PIPELINE_RESOLVE_AND_SUM_16F,
                                  PELLUCID_PIPELINE_RESOLVE_FOR_EDGES};
      EXPECT_EQ(find(plan, "resolve")->pipeline, makesLast ? last[quality - 1] : resolve[quality - 1]);
      EXPECT_EQ(reductions(plan), quality == 3 ? row.coarsest / 2 : 1) << row.distance;
      // Clusters and edges.
      EXPECT_EQ(plan.dispatchCount, 3 + reductions(plan) + (quality == 3 ? 2 : 0));
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
  f.frame.normal = f.frame.irradiance;
  EXPECT_EQ(f.plan().quality, 2u) << "default";
  for (uint32_t quality = 0; quality < kQualities; ++quality) {
    f.frame.quality = quality;
    for (const bool wide : {false, true}) {
      f.frame.outputFormat = wide ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
      const PellucidPlan plan = f.plan();
      EXPECT_EQ(plan.quality, quality);
      const uint32_t half = quality == 0   ? PELLUCID_PIPELINE_DIFFUSE_COARSE_16F
                            : quality == 3 ? PELLUCID_PIPELINE_DIFFUSE_PLANES_16F
                                           : PELLUCID_PIPELINE_DIFFUSE_16F;
      EXPECT_EQ(find(plan, "diffuse")->pipeline, half + wide);
      const PellucidDispatch* edges = find(plan, "diffuse edges");
      ASSERT_EQ(edges != nullptr, quality == 3);
      // At quality 2 they are summed beside the resolve, which then writes the output.
      const uint32_t sums = PELLUCID_PIPELINE_REDUCE_RESOLVE_AND_SUM_16F;
      EXPECT_EQ(find(plan, "resolve")->pipeline == sums + wide, quality == 2);
      if (!edges) continue;
      EXPECT_EQ(edges->pipeline, PELLUCID_PIPELINE_DIFFUSE_EDGES_16F + wide);
    }
  }
  f.frame.normal = {};
  f.frame.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  EXPECT_EQ(find(f.plan(), "diffuse edges"), nullptr) << "there are none";
  EXPECT_EQ(find(f.plan(), "diffuse")->pipeline, PELLUCID_PIPELINE_DIFFUSE_16F);
}

// Tiles of 16 x 16 pixels of the image, four to sixteen of a group, so that there are a thousand groups if
// that is enough.
TEST(Quality, GroupsThatSumHaveAllTiles) {
  struct Row {
    uint32_t x, y, width, height, tiles, ofGroup;
  };
  for (const Row& row :
       {Row{0, 0, 3840, 2160, 240 * 135, 16}, Row{0, 0, 1920, 1080, 120 * 68, 7},
        Row{0, 0, 7680, 4320, 480 * 270, 16}, Row{0, 0, 100, 50, 7 * 4, 4}, Row{15, 31, 2, 2, 4, 4}}) {
    Frame f;
    f.frame.normal = f.frame.irradiance;
    f.frame.imageExtent[0] = row.x + row.width;
    f.frame.imageExtent[1] = row.y + row.height;
    f.frame.renderRect[0] = row.x;
    f.frame.renderRect[1] = row.y;
    f.frame.renderRect[2] = row.width;
    f.frame.renderRect[3] = row.height;
    const PellucidPlan plan = f.plan();
    const PellucidDispatch* resolve = find(plan, "resolve");
    ASSERT_NE(resolve, nullptr);
    const uint32_t before = resolve->pushConstants[2] & 0xFFFF, ofGroup = resolve->pushConstants[2] >> 16;
    EXPECT_EQ(ofGroup, row.ofGroup);
    const uint32_t columns = resolve->groups[0], groups = (resolve->groups[1] - before) * columns;
    EXPECT_GE(groups * ofGroup, row.tiles) << row.width;
    EXPECT_LT((groups - columns) * ofGroup, row.tiles) << "a row of groups has nothing to do";
  }
}

// Gathered light is added when the resolve is done.
TEST(Quality, EdgesAreNotSummedBesideTheResolveWithAGather) {
  Frame f(1);
  f.frame.normal = Frame::view();
  f.frame.gatherSamples = 8;
  EXPECT_EQ(find(f.plan(), "reduce")->pipeline, PELLUCID_PIPELINE_REDUCE_LEVELS);
  f.frame.gatherSamples = 0;
  EXPECT_EQ(find(f.plan(), "reduce")->pipeline, PELLUCID_PIPELINE_REDUCE_FOR_SUMS);
}

// Against the table: the least quality that is below the target at every radius up to the frame's. Without
// normals those that sum edges are no better than the one before.
TEST(Quality, TargetErrorChoosesTheLeastThatHolds) {
  Frame f;
  f.frame.quality = 1;
  uint32_t chosen[kQualities] = {}, none = 0;
  for (const bool normals : {false, true}) {
    f.frame.normal = normals ? Frame::view() : PellucidImage{};
    const uint32_t qualities = normals ? kQualities : 2;
    for (const float radius : {0.0f, 0.4f, 0.5f, 1.9f, 7.0f, 30.0f, 128.0f, 400.0f}) {
      // 5 mm are 250 / p pixels. 0: not known, as good as the largest.
      f.frame.nearestDistance = radius > 0 ? 250 / radius * 1.0001f : 0;
      for (const float target : {1e-5f, 3e-4f, 0.007f, 0.02f, 0.03f, 0.05f, 0.07f, 0.5f}) {
        f.frame.targetError = target;
        uint32_t expected = qualities;
        for (uint32_t q = 0; q < qualities && expected == qualities; ++q) {
          bool holds = true;
          for (size_t i = 0; i < std::size(kErrorRadii); ++i) {
            const bool reached = radius == 0 || i == 0 || kErrorRadii[i - 1] < radius;
            holds = holds && (!reached || kWorstError[q][i] < target);
          }
          if (holds) expected = q;
        }
        const bool found = expected < qualities;
        const PellucidPlan plan = f.plan();
        EXPECT_EQ(plan.quality, found ? expected : kQualities - 1) << radius << " pixels, " << target;
        EXPECT_EQ(skipped(plan, "targetError"), found ? 0u : 1u) << radius << ", " << target;
        ++(found ? chosen[expected] : none);
      }
    }
  }
  EXPECT_GT(chosen[0], 0u);
  EXPECT_GT(chosen[1], 0u);
  EXPECT_GT(chosen[2], 0u);
  EXPECT_GT(chosen[3], 0u);
  EXPECT_GT(none, 0u);
}

TEST(Quality, IsInThePlansText) {
  Frame f;
  f.frame.nearestDistance = 50;
  const PellucidPlan plan = f.plan();
  char text[65536];
  size_t size = sizeof text;
  ASSERT_EQ(pellucidPlanToJson(&plan, text, &size), PELLUCID_OK);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("quality"), 2);
  EXPECT_NEAR(json.at("largestRadius").get<double>(), 5, 1e-5);
}

}  // namespace
