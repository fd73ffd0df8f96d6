#include "compute_pass.h"

namespace pellucid::bench {

using harness::check;

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
    : device_(device),
      types_(types),
      tile_(tile),
      sampler_(device),
      layout_(device, layoutBindings(types), {VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes}),
      pipeline_(device) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device.handle(), &info, nullptr, sampler_.receive()), "vkCreateSampler");
  createPipeline(spirv);
}

void ComputePass::createPipeline(std::span<const uint32_t> spirv) {
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < tile_.specialization.size(); ++i) entries.push_back({i, 4 * i, 4});
  const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                            4 * entries.size(), tile_.specialization.data()};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  harness::ShaderModule shader(device_);
  info.stage =
      harness::loadStage(device_, VK_SHADER_STAGE_COMPUTE_BIT, {spirv.data(), spirv.size_bytes()}, shader);
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout_;
  check(vkCreateComputePipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline_.receive()),
        "vkCreateComputePipelines");
}

void ComputePass::record(VkCommandBuffer commandBuffer, int width, int height,
                         const std::vector<Resource>& resources, const std::array<uint32_t, 4>& push) const {
  std::vector<VkDescriptorImageInfo> images(resources.size());
  std::vector<VkWriteDescriptorSet> writes;
  for (uint32_t i = 0; i < resources.size(); ++i) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = i;
    write.descriptorCount = 1;
    write.descriptorType = types_[i];
    if (const auto* image = std::get_if<PellucidImage>(&resources[i])) {
      images[i] = {sampler_, image->view, image->layout};
      write.pImageInfo = &images[i];
    } else {
      write.pBufferInfo = &std::get<VkDescriptorBufferInfo>(resources[i]);
    }
    writes.push_back(write);
  }
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  layout_.push(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, writes);
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes, push.data());
  const auto groups = [](int size, uint32_t tile) { return (static_cast<uint32_t>(size) + tile - 1) / tile; };
  vkCmdDispatch(commandBuffer, groups(width, tile_.width), groups(height, tile_.height), 1);
}

void computeBarrier(VkCommandBuffer commandBuffer) {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
  vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace pellucid::bench
