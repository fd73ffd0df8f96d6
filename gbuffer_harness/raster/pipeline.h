// Pipelines that draw, with pushed descriptors.
#pragma once

#include "common/push_layout.h"
#include "raster/draw_pass.h"

namespace pellucid::harness {

// Triangles without vertex buffers, of both faces, without a depth test; colors replace what is there.
struct DrawState {
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  bool depthBiasIsDynamic = false;  // where raster.depthBiasEnable is set
  // Each color image likewise.
  VkPipelineColorBlendAttachmentState blend{.colorWriteMask =
                                                VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                                VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
};

// Viewport and scissor are dynamic.
void createPipeline(const Device& device, const DrawPass& pass, const PushLayout& layout, const Spirv& vertex,
                    const Spirv& fragment, const DrawState& state, Pipeline& pipeline);

}  // namespace pellucid::harness
