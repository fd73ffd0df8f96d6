#include "compute_pass.h"

namespace pellucid::bench {

using harness::check;

ComputePass::ComputePass(harness::Device& device, std::span<const uint32_t> spirv,
                         const std::vector<VkDescriptorType>& types, const Tile& tile)
    : device_(device), types_(types), tile_(tile) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device.handle(), &info, nullptr, &sampler_), "vkCreateSampler");
  createLayout();
  createPipeline(spirv);
  pushDescriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"));
}

ComputePass::~ComputePass() {
  vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), setLayout_, nullptr);
  vkDestroySampler(device_.handle(), sampler_, nullptr);
}

void ComputePass::createLayout() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < types_.size(); ++i)
    bindings.push_back({i, types_[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<uint32_t>(bindings.size());
  set.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, &setLayout_),
        "vkCreateDescriptorSetLayout");
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, 16};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &setLayout_;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &push;
  check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, &layout_), "vkCreatePipelineLayout");
}

void ComputePass::createPipeline(std::span<const uint32_t> spirv) {
  VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  moduleInfo.codeSize = spirv.size_bytes();
  moduleInfo.pCode = spirv.data();
  VkShaderModule module;
  check(vkCreateShaderModule(device_.handle(), &moduleInfo, nullptr, &module), "vkCreateShaderModule");
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < tile_.specialization.size(); ++i) entries.push_back({i, 4 * i, 4});
  const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                            4 * entries.size(), tile_.specialization.data()};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout_;
  const VkResult result =
      vkCreateComputePipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
  vkDestroyShaderModule(device_.handle(), module, nullptr);
  check(result, "vkCreateComputePipelines");
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
  pushDescriptors_(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0,
                   static_cast<uint32_t>(writes.size()), writes.data());
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, 16, push.data());
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
