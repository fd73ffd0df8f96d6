#include "raster/pipeline.h"

#include <iterator>

namespace pellucid::harness {

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
