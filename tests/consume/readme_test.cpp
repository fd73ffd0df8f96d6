// The README's integration snippet, compiled as it stands there and run.
#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include <pellucid/pellucid.h>

#include "common/gpu_image.h"

// What the snippet expects of an engine.
struct GBuffer {
  uint32_t width, height;
  float metersPerUnit;
  float projection[16], view[16];
  PellucidImage depth, backFaceDepth, irradiance, materialId, scratch[7];
  uint32_t lightCount, shadowMapCount;
  const PellucidLight* lights;
  const PellucidShadowMap* shadowMaps;
  const PellucidImage* shadowImages;
};

#include "readme_snippet.inc"

namespace {

using namespace pellucid::harness;

constexpr float kIntensity[] = {10, 20};  // of the light in two frames

// Colors that the two frames show in their middle, times the reflectance of skin1, RGB. `slices`: of
// constants that they have.
std::array<std::array<double, 3>, 2> exitances(uint32_t slices) {
  Device device({"", true});
  Translucency t{};
  const VkDeviceSize sliceSize = pellucidGetConstantsSize(1, 1, 0);
  std::array<std::array<double, 3>, 2> result{};
  EXPECT_TRUE(createTranslucency(device.instance(), device.physicalDevice(), device.handle(), t));
  EXPECT_EQ(sliceSize % 256, 0u);

  constexpr int kSize = 16;
  const auto image = [&](VkFormat format, const Image& content) {
    auto gpu = std::make_unique<GpuImage>(device, kSize, kSize, format);
    gpu->upload(content);
    return gpu;
  };
  const auto depth = image(VK_FORMAT_R32_SFLOAT, Image(kSize, kSize, 1, 0.01f));     // 10 units away
  const auto back = image(VK_FORMAT_R32_SFLOAT, Image(kSize, kSize, 1, 0.1f / 12));  // 2 units behind
  // Of two frames in flight.
  const Image black(kSize, kSize, 3, 0.0f);
  const std::unique_ptr<GpuImage> irradiance[] = {image(VK_FORMAT_R16G16B16A16_SFLOAT, black),
                                                  image(VK_FORMAT_R16G16B16A16_SFLOAT, black)};
  GpuImage material(device, kSize, kSize, VK_FORMAT_R8_UINT);
  material.upload(std::vector<std::uint8_t>(kSize * kSize, 1));
  HostBuffer ring(device, slices * sliceSize,
                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                      VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);

  PellucidLight light{};
  light.direction[2] = 1;
  light.color[0] = light.color[1] = light.color[2] = 1;
  light.intensity = 10;
  GBuffer g{};
  g.width = g.height = kSize;
  g.metersPerUnit = 0.001f;
  const float projection[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};  // reversed, infinite
  std::copy_n(projection, 16, g.projection);
  for (int i = 0; i < 4; ++i) g.view[i * 5] = 1;
  g.depth = depth->use();
  g.backFaceDepth = back->use();
  g.irradiance = irradiance[0]->use();
  g.materialId = material.use();
  g.lightCount = 1;
  g.lights = &light;

  PellucidFrame frame;
  describeFrame(g, t, frame);
  PellucidImageNeed needs[7];
  uint32_t count = 7;
  EXPECT_EQ(pellucidGetImageNeeds(&frame, &count, needs), PELLUCID_OK);
  EXPECT_EQ(count, std::size(g.scratch));
  std::vector<std::unique_ptr<GpuImage>> scratch;
  for (uint32_t i = 0; i < count; ++i) {
    scratch.push_back(std::make_unique<GpuImage>(device, static_cast<int>(needs[i].extent[0]),
                                                 static_cast<int>(needs[i].extent[1]), needs[i].format));
    scratch[i]->clear();
    g.scratch[i] = scratch[i]->use();
  }

  // Both are recorded before the GPU runs either.
  device.run([&](VkCommandBuffer commandBuffer) {
    for (uint32_t i = 0; i < 2; ++i) {
      light.intensity = kIntensity[i];
      g.irradiance = irradiance[i]->use();
      describeFrame(g, t, frame);
      const VkDeviceSize at = i % slices * sliceSize;
      EXPECT_TRUE(recordTranslucency(commandBuffer, t, frame,
                                     {ring.handle(), at, sliceSize, static_cast<char*>(ring.mapped()) + at}));
      const VkMemoryBarrier scratchIsFree{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                                          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
      vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &scratchIsFree, 0, nullptr, 0,
                           nullptr);
    }
  });
  for (size_t i = 0; i < 2; ++i)
    for (int c = 0; c < 3; ++c)
      result[i][static_cast<size_t>(c)] =
          static_cast<double>(irradiance[i]->download().at(kSize / 2, kSize / 2)[c] * t.skin.reflectance[c]);
  pellucidDestroyContext(t.context);
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
  return result;
}

void expectLight(const std::array<double, 3>& exitance, double intensity) {
  // skin1 of Jensen et al. 2001, 1/mm: the slab's exact transmittance is known. 5e-3: the fit is good to
  // 1e-3, half floats to 5e-4, and 10 units in a 0.1-near infinite float depth to 1e-6.
  const double scattering[3] = {0.74, 0.88, 1.01}, absorption[3] = {0.032, 0.17, 0.48};
  for (size_t c = 0; c < 3; ++c) {
    PellucidSlab slab;
    ASSERT_EQ(pellucidSlabTransport(scattering[c], absorption[c], 1.4, 2, &slab, nullptr, nullptr),
              PELLUCID_OK);
    EXPECT_NEAR(exitance[c], intensity * slab.transmittance, 5e-3 * intensity * slab.transmittance)
        << "channel " << c;
  }
}

TEST(Readme, SnippetMakesASlabGlow) {
  const auto [first, second] = exitances(2);
  expectLight(first, kIntensity[0]);
  expectLight(second, kIntensity[1]);
}

// As the header says: the earlier frame has the later one's light, and no message tells.
TEST(Readme, OneSliceForTwoFramesShowsTheLaterLightTwice) {
  const auto [first, second] = exitances(1);
  expectLight(first, kIntensity[1]);
  expectLight(second, kIntensity[1]);
}

}  // namespace
