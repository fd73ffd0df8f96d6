// What a context is created for: output formats and pipelines.

#include "common/error.h"
#include "gpu_fixture.h"

namespace pellucid::test {
namespace {

using ContextTest = GpuTest;

Capture litSlab() {
  Capture c = flatCapture(32, 24);
  c.lights.push_back(backLight());
  for (size_t i = 0; i < c.irradiance.data.size(); i += 7) c.irradiance.data[i] = 3.7f;
  return c;
}

TEST_F(ContextTest, FormatsPatchedIntoShadersWriteTheSameBits) {
  constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Context fixed(device(), [&](PellucidContextDesc& desc) { desc.options.outputFormat = kFormat; });
  for (const uint32_t samples : {0u, 8u})
    EXPECT_TRUE(sameBits(record(FrameRun(device(), fixed, litSlab(), {testMaterial()}, gathering(samples))),
                         replay(litSlab(), testMaterial(), gathering(samples))));
}

TEST_F(ContextTest, RefusesOtherFormatsThanItsOwn) {
  const Context half(
      device(), [](PellucidContextDesc& desc) { desc.options.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT; });
  const ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  refusalOfRecording(FrameRun(device(), half, litSlab(), {testMaterial()}, s));
  EXPECT_NE(half.message().find("outputFormat is not"), std::string::npos) << half.message();

  const std::string said = refusalOf([] {
    Context(device(), [](PellucidContextDesc& d) { d.options.outputFormat = VK_FORMAT_R8G8B8A8_UNORM; });
  });
  EXPECT_NE(said.find("outputFormat is VkFormat 37"), std::string::npos) << said;
}

TEST_F(ContextTest, MakesThePipelinesOfItsUsesOnLentThreads) {
  const Context diffusion(device(), [](PellucidContextDesc& desc) {
    desc.options.uses = PELLUCID_USE_DIFFUSION;
    desc.options.parallelFor = [](void*, uint32_t count, void (*job)(void*, uint32_t), void* data) {
      for (uint32_t i = count; i-- > 0;) job(data, i);
    };
  });
  ReplaySettings s;
  s.features = PELLUCID_FEATURE_DIFFUSION;
  EXPECT_TRUE(sameBits(record(FrameRun(device(), diffusion, litSlab(), {testMaterial()}, s)),
                       replay(litSlab(), testMaterial(), s)));
  const std::string said =
      refusalOf([&] { record(FrameRun(device(), diffusion, litSlab(), {testMaterial()}, {})); });
  EXPECT_NE((said + diffusion.message()).find("plan needs PellucidContextOptions::uses with PELLUCID_USE_TRANSLUCENCY"), std::string::npos)
      << said;
  const auto unknown = [](PellucidContextDesc& desc) { desc.options.uses = 1u << 20; };
  EXPECT_THROW(Context(device(), unknown), DeviceError);
}

// Pipelines that do not look for an option change no frame without it, and frames with it are refused by its
// name.
TEST_F(ContextTest, OptionsThatUsesLeaveOut) {
  const Context lean(device(), [](PellucidContextDesc& desc) {
    desc.options.uses = PELLUCID_USE_TRANSLUCENCY | PELLUCID_USE_DIFFUSION | PELLUCID_USE_GATHER;
  });
  Capture c = litSlab();
  for (const uint32_t samples : {0u, 8u}) {
    ReplaySettings s;
    s.translucency.gatherSamples = samples;
    const FrameRun run(device(), lean, c, {testMaterial()}, s);
    EXPECT_TRUE(sameBits(record(run), replay(c, testMaterial(), s))) << samples << " samples";
  }

  const auto refuses = [&](const Capture& capture, const PellucidMaterial& material, const ReplaySettings& s,
                           const char* why) {
    EXPECT_NE(refusalOfRecording(FrameRun(device(), lean, capture, {material}, s)), "accepted");
    EXPECT_NE(lean.message().find(why), std::string::npos) << lean.message();
  };
  PellucidMaterial wall = testMaterial();
  wall.thinWalled = 1;
  refuses(c, wall, {}, "PELLUCID_USE_THIN_WALLS");
  PellucidMaterial gaussians = testMaterial();
  gaussians.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
  refuses(c, gaussians, {}, "PELLUCID_USE_THESIS");
  ReplaySettings angles;
  angles.translucency.angleModel = PELLUCID_ANGLE_INVERSE_COSINE;
  refuses(c, testMaterial(), angles, "PELLUCID_USE_THESIS");
  c.environment = Harmonics{};
  for (double& e : (*c.environment)[0]) e = 1;
  ReplaySettings ambient;
  ambient.ambient = true;
  refuses(c, testMaterial(), ambient, "PELLUCID_USE_AMBIENT");
}

}  // namespace
}  // namespace pellucid::test
