// Materials without thickness in plans and validation.
#include <algorithm>
#include <vector>

#include "frame_fixture.h"
#include "pellucid/pellucid_plan.h"
#include "shared/pellucid_shared.h"

namespace {

using pellucid::test::Frame;
using pellucid::test::names;
using pellucid::test::plainMaterial;

PellucidMaterial paper() {
  PellucidMaterial m{};
  m.structSize = sizeof m;
  m.thinWalled = 1;
  for (int c = 0; c < 3; ++c) {
    m.reflectance[c] = 0.5f;
    m.wallTransmittance[c] = 0.25f;
  }
  return m;
}

std::string reasonOf(const PellucidPlan& plan, const std::string& what) {
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].what == what) return plan.skips[i].reason;
  return "";
}

uint32_t imagesBound(const PellucidPlan& plan, const PellucidDispatch& d) {
  const std::vector<PellucidBinding> all = pellucid::test::bindingsOf(plan, d);
  return static_cast<uint32_t>(std::count_if(all.begin(), all.end(), [](const PellucidBinding& b) {
    return b.resource >= PELLUCID_RESOURCE_SHADOW0;
  }));
}

// A solid and a sheet, gathered.
struct Mixed : Frame {
  PellucidMaterial materials[2] = {plainMaterial(), paper()};
  explicit Mixed(uint32_t count = 1) : Frame(count) {
    frame.options.gatherSamples = 8;
    frame.materialCount = 2;
    frame.materials = materials;
    for (PellucidImage& image : frame.transients) image = view();
  }
};

TEST(ThinWall, GatheredFramesHaveADispatchMoreBeforeTheDiffusion) {
  Mixed f;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.gatherSamples, 8u);
  EXPECT_EQ(names(plan)[0], "thin walls");
  EXPECT_EQ(names(plan)[1], "base level");
  EXPECT_EQ(plan.dispatches[0].pushConstants[0], PELLUCID_LIGHT_WALLS);
  EXPECT_EQ(plan.dispatches[0].pushConstants[1], 1u);
  EXPECT_GT(imagesBound(plan, plan.dispatches[0]), 0u);
  f.frame.materialCount = 1;
  const std::vector<std::string> solids = names(f.plan());
  EXPECT_EQ(solids.size() + 1, plan.dispatchCount);
  EXPECT_EQ(std::count(solids.begin(), solids.end(), "thin walls"), 0);
}

TEST(ThinWall, FramesWithoutAGatherHaveNoOtherDispatches) {
  Mixed f;
  f.frame.options.gatherSamples = 0;
  const PellucidPlan mixed = f.plan();
  EXPECT_EQ(mixed.dispatches[0].pushConstants[0], PELLUCID_LIGHT_ALL);
  f.frame.materialCount = 1;
  EXPECT_EQ(names(mixed), names(f.plan()));
}

TEST(ThinWall, LightsThatAreNotGatheredAddToEachMaterialOnce) {
  Mixed f;
  f.lights.push_back(Frame::light(0, 0));
  PellucidShadowMap back = f.maps[0];
  back.options.backFaces = 1;
  f.maps.push_back(back);
  f.lights.push_back(Frame::light(1, 1));
  f.use();
  f.frame.materialCount = 2;
  f.frame.materials = f.materials;
  const PellucidPlan plan = f.plan();
  const std::vector<std::string> all = names(plan);
  uint32_t walls = 0;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    if (all[i] == "thin walls") walls += plan.dispatches[i].pushConstants[1];
    if (all[i] == "translucency") {
      EXPECT_EQ(plan.dispatches[i].pushConstants[0], PELLUCID_LIGHT_SOLIDS);
    }
  }
  EXPECT_EQ(walls, 3u);
}

TEST(ThinWall, FramesOfThinWallsAloneGatherNothingAndSayWhy) {
  Mixed f;
  f.frame.materials = &f.materials[1];
  f.frame.materialCount = 1;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.gatherSamples, 0u);
  EXPECT_EQ(names(plan), std::vector<std::string>{"translucency"});
  EXPECT_EQ(reasonOf(plan, "gather"), "every material is thin-walled");
  EXPECT_EQ(reasonOf(plan, "diffusion"), "no material diffuses");
}

// A sheet's light needs no thickness.
TEST(ThinWall, LightsNeedNoBackDepth) {
  Mixed f(0);
  f.frame.backDepth = {};
  EXPECT_EQ(f.plan().activeLights, 1u);
  EXPECT_NE(reasonOf(f.plan(), "light in solids").find("no back depth"), std::string::npos);
  f.frame.materials = &f.materials[1];
  f.frame.materialCount = 1;
  EXPECT_EQ(f.plan().activeLights, 1u);
  EXPECT_EQ(reasonOf(f.plan(), "light in solids"), "");
  f.frame.materials = f.materials;
  EXPECT_EQ(f.plan().activeLights, 0u);
}

// T(d) does not count, unlike with solids.
TEST(ThinWall, TransmittanceIsNotRead) {
  Mixed f;
  f.materials[1].transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
  EXPECT_EQ(f.plan().gatherSamples, 8u);
  f.materials[1] = plainMaterial();
  f.materials[1].transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
  EXPECT_EQ(f.plan().gatherSamples, 0u);
  EXPECT_NE(reasonOf(f.plan(), "gather"), "");
}

TEST(ThinWall, MoreLightThanArrivesIsRefusedByName) {
  Mixed f;
  f.materials[1].wallTransmittance[2] = 0.6f;
  EXPECT_EQ(f.problems(),
            "materials[1].wallTransmittance of channel 2 is 0.6 with a reflectance of 0.5; more light leaves "
            "a thin wall than arrives\n");
  f.materials[1].wallTransmittance[2] = -0.25f;
  EXPECT_NE(f.problems().find("materials[1].wallTransmittance [2] is -0.25"), std::string::npos)
      << f.problems();
  f.materials[1].wallTransmittance[2] = 0.5f;
  EXPECT_EQ(f.problems(), "");
  f.materials[1].thinWalled = 2;
  EXPECT_NE(f.problems().find("materials[1].thinWalled is 2"), std::string::npos) << f.problems();
  // Solids do not read it.
  f.materials[1] = plainMaterial();
  f.materials[1].wallTransmittance[0] = 7;
  EXPECT_EQ(f.problems(), "");
}

}  // namespace
