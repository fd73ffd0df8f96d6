// A multisampled G-buffer: compute/multisample/resolve_gbuffer.comp before the module and a blend after it,
// against a frame of four pixels for each.
#include <algorithm>
#include <bit>
#include <cstdio>

#include "common/barrier.h"
#include "common/push_layout.h"
#include "gpu_fixture.h"
#include "kFillSamples.h"
#include "kFillWholeSamples.h"
#include "kResolveGbuffer.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

constexpr int kSide = 96, kSamples = 4;
constexpr std::array<float, 3> kSky = {0.5f, 0.6f, 0.7f};

// An image of four samples a pixel, in GENERAL.
class SampledImage {
public:
  SampledImage(Device& device, VkFormat format) : memory_(device), image_(device), view_(device) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {kSide, kSide, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_4_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    check(vkCreateImage(device.handle(), &info, nullptr, image_.receive()), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle(), image_, &needs);
    VkMemoryAllocateInfo allocate{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
        device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    check(vkAllocateMemory(device.handle(), &allocate, nullptr, memory_.receive()), "vkAllocateMemory");
    check(vkBindImageMemory(device.handle(), image_, memory_, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &view, nullptr, view_.receive()), "vkCreateImageView");
    device.run([&](VkCommandBuffer commands) {
      VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
      barrier.dstAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
      barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
      barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.image = image_;
      barrier.subresourceRange = view.subresourceRange;
      vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                           0, 0, nullptr, 0, nullptr, 1, &barrier);
    });
  }
  PellucidImage use() const { return {view_, VK_IMAGE_LAYOUT_GENERAL}; }

private:
  Owned<VkDeviceMemory, vkFreeMemory> memory_;
  Owned<VkImage, vkDestroyImage> image_;
  Owned<VkImageView, vkDestroyImageView> view_;
};

// A compute shader over all pixels, whose images are sampled or stored to.
class ComputePass {
public:
  // stored: bits of the bindings that are storage images. constants: bytes.
  ComputePass(Device& device, const Spirv& code, std::uint32_t bindings, std::uint32_t stored,
              std::uint32_t constants)
      : device_(device),
        stored_(stored),
        layout_(device, listed(bindings, stored), {VK_SHADER_STAGE_COMPUTE_BIT, 0, constants}),
        pipeline_(device) {
    ShaderModule shader(device);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = loadStage(device, VK_SHADER_STAGE_COMPUTE_BIT, code, shader);
    info.layout = layout_;
    check(vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline_.receive()),
          "vkCreateComputePipelines");
  }
  void run(const std::vector<PellucidImage>& images, const std::vector<std::uint32_t>& constants = {}) const {
    DescriptorWrites writes;
    for (std::uint32_t i = 0; i < images.size(); ++i)
      writes.image(i, typeOf(i, stored_), VK_NULL_HANDLE, images[i]);
    device_.run([&](VkCommandBuffer commands) {
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
      layout_.push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, writes.all());
      if (!constants.empty())
        vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(4 * constants.size()), constants.data());
      vkCmdDispatch(commands, (kSide + 7) / 8, (kSide + 7) / 8, 1);
      barrier(commands, kComputing, kComputing);
    });
  }

private:
  static VkDescriptorType typeOf(std::uint32_t binding, std::uint32_t stored) {
    return stored >> binding & 1 ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  }
  static std::vector<VkDescriptorSetLayoutBinding> listed(std::uint32_t count, std::uint32_t stored) {
    std::vector<VkDescriptorSetLayoutBinding> all;
    for (std::uint32_t i = 0; i < count; ++i)
      all.push_back({i, typeOf(i, stored), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    return all;
  }

  Device& device_;
  std::uint32_t stored_;
  PushLayout layout_;
  Pipeline pipeline_;
};

// A head in front of a bright sky, of four pixels for each of the G-buffer's.
const Capture& large() {
  static const Capture made = [] {
    Capture c = makeScene({.name = "head", .width = 2 * kSide, .height = 2 * kSide, .shadowSize = 256});
    for (std::size_t i = 0; i < c.material.size(); ++i)
      for (std::size_t k = 0; c.material[i] == 0 && k < 3; ++k) {
        c.irradiance.data[c.irradiance.channels * i + k] = kSky[k];
        if (!c.albedo.empty()) c.albedo.data[3 * i + k] = 1;
      }
    return c;
  }();
  return made;
}

class Multisample : public GpuTest {
protected:
  // The frame of one sample a pixel, with what the shader makes of the images.
  static Capture resolved(const Capture& c) {
    ComputePass fill(device(), {kFillSamples, sizeof kFillSamples}, 2, 0b10, 0),
        fillWhole(device(), {kFillWholeSamples, sizeof kFillWholeSamples}, 2, 0b10, 0),
        resolve(device(), {kResolveGbuffer, sizeof kResolveGbuffer}, 10, 0b1010111000, 24);
    constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;
    const auto sampled = [&](const Image& image) {
      GpuImage source(device(), 2 * kSide, 2 * kSide, kWide);
      source.upload(image);
      auto result = std::make_unique<SampledImage>(device(), kWide);
      fill.run({source.use(), result->use()});
      return result;
    };
    GpuImage indices(device(), 2 * kSide, 2 * kSide, VK_FORMAT_R32_UINT);
    std::vector<std::uint32_t> words;  // beside other data
    for (const std::uint8_t m : c.material)
      words.push_back(m << 8 | static_cast<std::uint32_t>(words.size() % 251));
    indices.upload(words);
    SampledImage material(device(), VK_FORMAT_R32_UINT);
    fillWhole.run({indices.use(), material.use()});
    const auto front = sampled(c.frontDepth.image), back = sampled(c.backDepth.image),
               light = sampled(c.irradiance), albedo = sampled(c.albedo);
    GpuImage depths[2] = {{device(), kSide, kSide, VK_FORMAT_R32_SFLOAT},
                          {device(), kSide, kSide, VK_FORMAT_R32_SFLOAT}};
    GpuImage colors[2] = {{device(), kSide, kSide, kWide}, {device(), kSide, kSide, kWide}};
    GpuImage index(device(), kSide, kSide, VK_FORMAT_R32_UINT);
    for (GpuImage* image : {&depths[0], &depths[1], &colors[0], &colors[1], &index}) image->clear();
    resolve.run({front->use(), material.use(), light->use(), depths[0].use(), index.use(), colors[0].use(),
                 back->use(), depths[1].use(), albedo->use(), colors[1].use()},
                {0, 0, kSide, kSide, 0xFF00, 8});
    Capture small = c;
    small.width = small.height = kSide;
    small.material.resize(kSide * kSide);
    small.frontDepth.image = depths[0].download();
    small.backDepth.image = depths[1].download();
    small.irradiance = colors[0].download();
    small.albedo = rgb(colors[1].download());
    const Image stored = index.download();
    std::transform(stored.data.begin(), stored.data.end(), small.material.begin(), [](float bits) {
      return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(bits) >> 8);
    });
    return small;
  }
};

// A sample is one of the four pixels.
int place(int x, int y, int sample) { return (2 * y + (sample >> 1)) * 2 * kSide + 2 * x + (sample & 1); }

TEST_F(Multisample, ThePixelIsItsMostFrequentMaterial) {
  Capture c = large();
  for (std::size_t i = 0; i < c.material.size(); ++i)
    if (c.material[i] != 0 && i / 5 % 3 == 0) c.material[i] = 2;
  const Capture small = resolved(c);
  int edges = 0, mixtures = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      int count[256] = {}, most = 0;
      for (int s = 0; s < kSamples; ++s) ++count[c.material[place(x, y, s)]];
      for (int s = 0; s < kSamples; ++s) {
        const int m = c.material[place(x, y, s)];  // of equally frequent materials the first counts
        if (m != 0 && (most == 0 || count[m] > count[most])) most = m;
      }
      const int covered = kSamples - count[0];
      ASSERT_EQ(small.material[y * kSide + x], most);
      ASSERT_EQ(small.irradiance.at(x, y)[3], 0.25f * static_cast<float>(covered));
      edges += covered > 0 && covered < kSamples;
      mixtures += count[1] > 0 && count[2] > 0;
      double sum = 0;
      bool isASample = false;
      for (int s = 0; s < kSamples; ++s) {
        const int i = place(x, y, s);
        if (most != 0 && c.material[i] != most) continue;
        sum += double(c.irradiance.data[c.irradiance.channels * i]);
        isASample |= c.frontDepth.image.data[i] == *small.frontDepth.image.at(x, y);
      }
      ASSERT_NEAR(*small.irradiance.at(x, y), sum / (most == 0 ? kSamples : count[most]), 1e-6);
      ASSERT_TRUE(isASample);
    }
  EXPECT_GT(edges, 50);
  EXPECT_GT(mixtures, 50);
}

// Blended by its alpha over what the engine has at the samples without a material. Without the shader, an average over all
// samples or one sample, edges err by five times as much and more.
TEST_F(Multisample, EdgesAreNearThoseOfFourPixels) {
  const Capture &c = large(), small = resolved(c);
  const Image four = replay(c, inFloats()), result = replay(small, inFloats());
  double edge = 0, all = 0, edgeSquares = 0, squares = 0, halo = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float coverage = small.irradiance.at(x, y)[3];
      if (coverage == 0) continue;
      ASSERT_EQ(result.at(x, y)[3], coverage) << "the module keeps the irradiance's alpha";
      for (int k = 0; k < 3; ++k) {
        double truth = 0, least = 1e9, most = 0;
        for (int i = 0; i < kSamples; ++i) truth += double(four.data[4 * place(x, y, i) + k]) / kSamples;
        for (int j = std::max(2 * y - 2, 0); j < std::min(2 * y + 4, 2 * kSide); ++j)
          for (int i = std::max(2 * x - 2, 0); i < std::min(2 * x + 4, 2 * kSide); ++i) {
            least = std::min(least, double(four.at(i, j)[k]));
            most = std::max(most, double(four.at(i, j)[k]));
          }
        const double blended = double(coverage * result.at(x, y)[k] + (1 - coverage) * kSky[k]);
        halo = std::max({halo, least - blended, blended - most});
        squares += truth * truth;
        all += (blended - truth) * (blended - truth);
        edgeSquares += coverage < 1 ? truth * truth : 0;
        edge += coverage < 1 ? (blended - truth) * (blended - truth) : 0;
      }
    }
  // Most of it is what a frame of a quarter of the pixels differs by.
  EXPECT_LT(std::sqrt(edge / edgeSquares), 0.04);
  EXPECT_LT(std::sqrt(all / squares), 0.04);
  EXPECT_LT(halo, 0.01);
}

}  // namespace
