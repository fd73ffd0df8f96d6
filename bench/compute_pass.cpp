#include "compute_pass.h"

namespace pellucid::bench {

namespace {

constexpr uint32_t kPushBytes = 16;

std::vector<VkDescriptorSetLayoutBinding> layoutBindings(const std::vector<VkDescriptorType>& types) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < types.size(); ++i)
    bindings.push_back({i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  return bindings;
}

}  // namespace

ComputePass::ComputePass(harness::Device& device, std::span<const uint32_t> spirv,
                         const std::vector<VkDescriptorType>& types, const Tile& tile)
    : types_(types),
      tile_(tile),
      sampler_(device),
      layout_(device, layoutBindings(types), {VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes}),
      pipeline_(device) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  harness::check(vkCreateSampler(device.handle(), &info, nullptr, sampler_.receive()), "vkCreateSampler");
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < tile.specialization.size(); ++i) entries.push_back({i, 4 * i, 4});
  harness::createPipeline(
      device, layout_, {spirv.data(), spirv.size_bytes()},
      {static_cast<uint32_t>(entries.size()), entries.data(), 4 * entries.size(), tile.specialization.data()},
      pipeline_);
}

void ComputePass::record(VkCommandBuffer commandBuffer, int width, int height,
                         const std::vector<Resource>& resources, const std::array<uint32_t, 4>& push) const {
  harness::DescriptorWrites writes;
  for (uint32_t i = 0; i < resources.size(); ++i)
    if (const auto* image = std::get_if<PellucidImage>(&resources[i]))
      writes.image(i, types_[i], sampler_, *image);
    else
      writes.buffer(i, types_[i], std::get<VkDescriptorBufferInfo>(resources[i]));
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  layout_.push(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, writes.all());
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes, push.data());
  const auto groups = [](int size, uint32_t tile) { return (static_cast<uint32_t>(size) + tile - 1) / tile; };
  vkCmdDispatch(commandBuffer, groups(width, tile_.width), groups(height, tile_.height), 1);
}

}  // namespace pellucid::bench
