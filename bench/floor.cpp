#include "floor.h"

#include "kFloor.h"

namespace pellucid::bench {

using harness::check;
using harness::Image;

FloorPass::FloorPass(harness::Device& device, int width, int height)
    : device_(device),
      width_(width),
      height_(height),
      front_(device, width, height, VK_FORMAT_R32_SFLOAT),
      back_(device, width, height, VK_FORMAT_R32_SFLOAT),
      irradiance_(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT),
      result_(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT) {
  front_.upload(Image(width, height, 1, 1.0f));
  back_.upload(Image(width, height, 1, 3.0f));
  irradiance_.upload(Image(width, height, 4, 0.5f));
  result_.clear();
  VkDescriptorSetLayoutBinding bindings[4];
  for (uint32_t i = 0; i < 4; ++i)
    bindings[i] = {i, i < 3 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1,
                   VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = 4;
  set.pBindings = bindings;
  check(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &setLayout_),
        "vkCreateDescriptorSetLayout");
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &setLayout_;
  check(vkCreatePipelineLayout(device.handle(), &layout, nullptr, &layout_), "vkCreatePipelineLayout");
  VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  moduleInfo.codeSize = sizeof kFloor;
  moduleInfo.pCode = kFloor;
  VkShaderModule module;
  check(vkCreateShaderModule(device.handle(), &moduleInfo, nullptr, &module), "vkCreateShaderModule");
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.layout = layout_;
  const VkResult result =
      vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
  vkDestroyShaderModule(device.handle(), module, nullptr);
  check(result, "vkCreateComputePipelines");
  pushDescriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"));
}

FloorPass::~FloorPass() {
  vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), setLayout_, nullptr);
}

void FloorPass::record(VkCommandBuffer commandBuffer) const {
  const harness::GpuImage* images[] = {&front_, &back_, &irradiance_, &result_};
  VkDescriptorImageInfo infos[4];
  VkWriteDescriptorSet writes[4];
  for (uint32_t i = 0; i < 4; ++i) {
    infos[i] = {VK_NULL_HANDLE, images[i]->use().view, images[i]->use().layout};
    writes[i] = VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = i < 3 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    writes[i].pImageInfo = &infos[i];
  }
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  pushDescriptors_(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 4, writes);
  vkCmdDispatch(commandBuffer, static_cast<uint32_t>(width_ + 7) / 8, static_cast<uint32_t>(height_ + 7) / 8,
                1);
}

bool FloorPass::isRight() const {
  const Image result = result_.download();
  for (float v : result.data)
    if (v != 2.5f) return false;
  return true;
}

}  // namespace pellucid::bench
