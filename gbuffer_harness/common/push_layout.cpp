#include "common/push_layout.h"

namespace pellucid::harness {

VkPipelineShaderStageCreateInfo loadStage(const Device& device, VkShaderStageFlagBits stage,
                                          const Spirv& code, ShaderModule& shader) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code.bytes;
  info.pCode = code.words;
  check(vkCreateShaderModule(device.handle(), &info, nullptr, shader.receive()), "vkCreateShaderModule");
  VkPipelineShaderStageCreateInfo result{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  result.stage = stage;
  result.module = shader;
  result.pName = "main";
  return result;
}

PushLayout::PushLayout(Device& device, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                       const VkPushConstantRange& constants)
    : device_(device),
      setLayout_(device),
      layout_(device),
      pushDescriptors_(reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
          vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"))) {
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (device.pushes()) set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, setLayout_.receive()),
        "vkCreateDescriptorSetLayout");
  const VkDescriptorSetLayout sets[] = {setLayout_};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = sets;
  layout.pushConstantRangeCount = constants.size > 0;
  layout.pPushConstantRanges = &constants;
  check(vkCreatePipelineLayout(device.handle(), &layout, nullptr, layout_.receive()),
        "vkCreatePipelineLayout");
}

void PushLayout::push(VkCommandBuffer commandBuffer, VkPipelineBindPoint point,
                      std::span<const VkWriteDescriptorSet> writes) const {
  const auto count = static_cast<std::uint32_t>(writes.size());
  if (device_.pushes()) return pushDescriptors_(commandBuffer, point, layout_, 0, count, writes.data());
  const VkDescriptorSet set = device_.setForRun(setLayout_);
  std::vector<VkWriteDescriptorSet> ofSet(writes.begin(), writes.end());
  for (VkWriteDescriptorSet& write : ofSet) write.dstSet = set;
  vkUpdateDescriptorSets(device_.handle(), count, ofSet.data(), 0, nullptr);
  vkCmdBindDescriptorSets(commandBuffer, point, layout_, 0, 1, &set, 0, nullptr);
}

void createPipeline(const Device& device, const PushLayout& layout, const Spirv& compute,
                    const VkSpecializationInfo& constants, Pipeline& pipeline) {
  ShaderModule shader(device);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = loadStage(device, VK_SHADER_STAGE_COMPUTE_BIT, compute, shader);
  info.stage.pSpecializationInfo = &constants;
  info.layout = layout;
  check(vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline.receive()),
        "vkCreateComputePipelines");
}

}  // namespace pellucid::harness
