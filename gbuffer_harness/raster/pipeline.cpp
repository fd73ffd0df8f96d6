#include "raster/pipeline.h"

#include <iterator>

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

PushLayout::PushLayout(const Device& device, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                       const VkPushConstantRange& constants)
    : setLayout_(device),
      layout_(device),
      pushDescriptors_(reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
          vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"))) {
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
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
  pushDescriptors_(commandBuffer, point, layout_, 0, static_cast<std::uint32_t>(writes.size()),
                   writes.data());
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

void createPipeline(const Device& device, const DrawPass& pass, const PushLayout& layout, const Spirv& vertex,
                    const Spirv& fragment, const DrawState& state, Pipeline& pipeline) {
  ShaderModule vertexShader(device), fragmentShader(device);
  const VkPipelineShaderStageCreateInfo stages[] = {
      loadStage(device, VK_SHADER_STAGE_VERTEX_BIT, vertex, vertexShader),
      loadStage(device, VK_SHADER_STAGE_FRAGMENT_BIT, fragment, fragmentShader)};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const std::vector<VkPipelineColorBlendAttachmentState> blends(pass.colorCount(), state.blend);
  VkPipelineColorBlendStateCreateInfo colors{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  colors.attachmentCount = static_cast<std::uint32_t>(blends.size());
  colors.pAttachments = blends.data();
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                          VK_DYNAMIC_STATE_DEPTH_BIAS};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = state.depthBiasIsDynamic ? 3 : 2;
  dynamic.pDynamicStates = dynamicStates;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = static_cast<std::uint32_t>(std::size(stages));
  info.pStages = stages;
  info.pVertexInputState = &state.input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &state.raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &state.depth;
  info.pColorBlendState = &colors;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  info.renderPass = pass.renderPass();
  check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline.receive()),
        "vkCreateGraphicsPipelines");
}

}  // namespace pellucid::harness
