// The light-space gather where its answer is known: K_T integrates to T(d) over a slab.
#include "gpu_fixture.h"

#include <cstdio>
#include <limits>

#include "common/error.h"

namespace {

using namespace pellucid::test;

using Gather = GpuTest;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Texels of 0.2 mm, so that the camera's view of a face is not mistaken for the face behind it, across 50 mm:
// 0.1 % of the light that leaves 4 mm of slab enters beyond.
void cover50mm(ShadowMap& map) {
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.04;
  map.depth.image = Image(256, 256, 1, map.depth.image.data[0]);
}

Capture backlitSlab(double thickness, PellucidDepthEncoding encoding) {
  Capture c = flatCapture(8, 8, thickness);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-10 - thickness, encoding)};
  cover50mm(c.lights[0].shadowMaps[0]);
  return c;
}

ReplaySettings settings(uint32_t samples) {
  ReplaySettings s;
  s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  s.translucency.gatherSamples = samples;
  return s;
}

double transmittance(int channel, double d) {
  return channel == 0   ? std::exp(-d / 2)
         : channel == 1 ? std::exp(-d)
                        : 0.7 * std::exp(-2 * d) + 0.3 * std::exp(-d / 4);
}

// What the table in place of T(h) and q(h) is off by, at most.
constexpr double kFitted = 0.02;

TEST_F(Gather, IsTheSlabsTransmittance) {
  for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z, PELLUCID_DEPTH_DISTANCE})
    for (const double d : {0.5, 1.0, 2.0, 4.0}) {
      const Capture c = backlitSlab(d, encoding);
      const Image out = replay(c, testMaterial(), settings(64));
      for (int k = 0; k < 3; ++k) {
        const double added = static_cast<double>(out.at(4, 4)[k] - c.irradiance.at(4, 4)[k]);
        const double exact = 6 * transmittance(k, d);
        EXPECT_NEAR(added, exact, kFitted * exact) << "d " << d << " channel " << k;
      }
    }
}

// Rings are integrated, so that the number of samples does not matter where depth is constant.
TEST_F(Gather, SlabsAreRightWithFewSamples) {
  for (const uint32_t samples : {4u, 8u, 16u})
    for (const double d : {0.5, 1.0, 2.0, 4.0}) {
      const Capture c = backlitSlab(d, PELLUCID_DEPTH_VIEW_Z);
      const Image out = replay(c, testMaterial(), settings(samples));
      for (int k = 0; k < 3; ++k) {
        const double exact = 6 * transmittance(k, d);
        EXPECT_NEAR(static_cast<double>(out.at(4, 4)[k] - c.irradiance.at(4, 4)[k]), exact, kFitted * exact)
            << samples << " samples, d " << d << " channel " << k;
      }
    }
}

// Lit from the front: the camera sees what it sees, and beyond the image's edges lies more of the same.
TEST_F(Gather, ConstantLightStaysConstant) {
  Capture c = flatCapture(8, 8, 2);
  c.backDepth = {};  // a thin slab returns less
  Light front = backLight();
  front.direction = {0, 0, -1};
  for (size_t i = 0; i < c.irradiance.data.size(); ++i) c.irradiance.data[i] = 3;
  ShadowMap map;
  map.clipFromWorld = kIdentity;
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.01;
  map.clipFromWorld[10] = -1.0 / 100;  // grows towards -z from z = 0
  map.viewFromWorld = kIdentity;
  map.depth.encoding = PELLUCID_DEPTH_VIEW_Z;
  map.depth.image = Image(1, 1, 1, 10);
  cover50mm(map);
  front.shadowMaps = {map};
  c.lights = {front};
  const Image out = replay(c, testMaterial(), settings(32));
  // What enters beyond the edges stands for as much as it displaces.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(out.at(4, 4)[k], 3, 6e-3);
  // Nothing to displace where nothing diffuses.
  ReplaySettings undiffused = settings(32);
  undiffused.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const Image alone = replay(c, testMaterial(), undiffused);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(alone.at(4, 4)[k], 3, 1e-5);
}

TEST_F(Gather, NothingFromOutsideOrEmptyTexels) {
  Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  for (const float nothing : {pellucid::harness::kNoDepth, 0.0f, kNan}) {
    for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = nothing;
    EXPECT_NEAR(replay(c, testMaterial(), settings(16)).at(4, 4)[0], 1, 1e-5) << nothing;
  }
  c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  c.lights[0].shadowMaps[0].clipFromWorld[12] = 5;
  EXPECT_NEAR(replay(c, testMaterial(), settings(16)).at(4, 4)[0], 1, 1e-5);
}

TEST_F(Gather, StaysFinite) {
  Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  const float bad[] = {kNan, INFINITY, -1, 0, 60, 60.0001f, 1e8f, 1e-8f, 59};
  size_t i = 0;
  for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = bad[i++ % std::size(bad)];
  for (int x = 0; x < 8; ++x) {
    c.normal.at(x, 2)[2] = kNan;
    c.frontDepth.image.at(x, 3)[0] = bad[static_cast<size_t>(x)];
  }
  const Image out = replay(c, testMaterial(), settings(64));
  for (size_t p = 0; p < out.data.size(); ++p)
    EXPECT_TRUE(std::isfinite(out.data[p]) && out.data[p] >= 0) << p;
}

// What points find does not wait for the diffusion, which does not wait for them: only the last dispatch, the
// diffusion's own, needs both.
TEST_F(Gather, PlanGathersBesideTheDiffusion) {
  const Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  ReplaySettings coarse = settings(8);
  coarse.translucency.gatherSpacing = 4;
  for (const auto indirect : {PELLUCID_INDIRECT_NONE, PELLUCID_INDIRECT_LIGHT}) {
    coarse.indirectDispatches = indirect;
    const PellucidPlan plan = replayer().run(c, {testMaterial()}, coarse).plan;
    std::vector<std::string> beside, decided;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
      const PellucidDispatch& d = plan.dispatches[i];
      if (i > 0 && !d.barrierBefore) beside.push_back(d.name);
      if (d.indirect) decided.push_back(d.name);
      EXPECT_EQ(d.barrierIndirect != 0, indirect && d.name == std::string("upsample"))
          << "the spatial filter, the first that the GPU decides about, runs beside upsampling";
    }
    EXPECT_EQ(beside, (std::vector<std::string>{"entry points", "probes", "filter probes"}));
    using Names = std::vector<std::string>;
    EXPECT_EQ(decided, indirect ? Names({"filter probes", "diffuse", "diffuse, none gathered"}) : Names());
    EXPECT_STREQ(pellucidPipelineName(plan.dispatches[plan.dispatchCount - (indirect ? 2 : 1)].pipeline),
                 "diffuse_gathered");
  }
}

// The GPU leaves out what no point has light for, and finds the same pixels.
TEST_F(Gather, SkipsWhatFindsNoLight) {
  struct Case {
    const char* name;
    Capture capture;
    bool light;
  };
  Case fromBehind{"slab lit from behind", flatCapture(64, 64, 1), true};
  fromBehind.capture.lights = {backLight()};
  fromBehind.capture.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z)};
  cover50mm(fromBehind.capture.lights[0].shadowMaps[0]);
  Case fromTheFront{"slab lit from the front", flatCapture(64, 64, 1), false};
  fromTheFront.capture.backDepth = {};  // a thin slab returns less
  Light light = backLight();
  light.direction = {0, 0, -1};
  // What the camera sees, and no more.
  light.shadowMaps = {flatShadowMap(0, PELLUCID_DEPTH_DEVICE)};
  light.shadowMaps[0].clipFromWorld = fromTheFront.capture.clipFromView;
  light.shadowMaps[0].depth.image = Image(64, 64, 1, 0.1f);
  fromTheFront.capture.lights = {light};
  Case curved{"the same, its normals turned", fromTheFront.capture, true};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float tilt = 0.02f * static_cast<float>(x - 32), scale = 1 / std::hypot(tilt, 1.0f);
      curved.capture.normal.at(x, y)[0] = scale * tilt;
      curved.capture.normal.at(x, y)[2] = scale;
    }

  const Context& context = replayer().contextFor(curved.capture);
  for (const Case& c : {fromBehind, fromTheFront, curved}) {
    SCOPED_TRACE(c.name);
    ReplaySettings s = settings(8);
    s.translucency.gatherSpacing = 4;
    s.indirectDispatches = PELLUCID_INDIRECT_LIGHT;
    const std::vector<PellucidMaterial> materials(c.capture.materials.size(), testMaterial());
    const FrameRun run(device(), context, c.capture, materials, s);
    device().run([&](VkCommandBuffer commands) { run.record(commands); });
    for (uint32_t i = 0; i < run.plan().dispatchCount; ++i) {
      const PellucidDispatch& d = run.plan().dispatches[i];
      if (!d.indirect) continue;
      VkDispatchIndirectCommand command;
      std::memcpy(&command, static_cast<const char*>(run.constants()) + d.indirectOffset, sizeof command);
      const bool runs = (d.name == std::string("diffuse, none gathered")) != c.light;
      EXPECT_EQ(command.x, runs ? d.groups[0] : 0) << d.name;
      EXPECT_EQ(command.y, d.groups[1]) << d.name;
      EXPECT_EQ(command.z, 1u) << d.name;
    }
    s.indirectDispatches = PELLUCID_INDIRECT_NONE;
    EXPECT_TRUE(sameBits(run.output(), replayer().run(c.capture, materials, s).output));
  }
}

// Gathered light has already spread: lights without a map and marked pixels need a dispatch after the
// diffusion.
TEST_F(Gather, OtherLightsAreAddedAfterTheDiffusion) {
  Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  const auto last = [&](const ReplaySettings& s) {
    const PellucidPlan plan = replayer().run(c, {testMaterial()}, s).plan;
    return std::string(pellucidPipelineName(plan.dispatches[plan.dispatchCount - 1].pipeline));
  };
  ReplaySettings s = settings(8);
  s.indirectDispatches = PELLUCID_INDIRECT_NONE;
  s.translucency.gatherSpacing = 2;
  EXPECT_EQ(last(s), "add_gathered");
  s.translucency.gatherSpacing = 4;
  s.translucency.materialMarkBit = 128;
  EXPECT_EQ(last(s), "add_gathered");
  s.translucency.materialMarkBit = 0;
  EXPECT_EQ(last(s), "diffuse_gathered");
  c.lights.push_back(backLight());
  EXPECT_EQ(last(s), "add_gathered");
}

TEST_F(Gather, RefusesWhatItCannotSample) {
  const Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  EXPECT_THROW(replay(c, testMaterial(), settings(6)), InputError);
  EXPECT_THROW(replay(c, testMaterial(), settings(68)), InputError);
  PellucidMaterial gaussians = testMaterial();
  gaussians.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
  EXPECT_THROW(replay(c, gaussians, settings(8)), InputError);
}

}  // namespace
