// Layouts and pipelines of passes whose descriptors are pushed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "common/device.h"
#include "common/owned.h"
#include "pellucid/pellucid.h"
#include "raster/draw_pass.h"

namespace pellucid::harness {

struct Spirv {
  const std::uint32_t* words;
  std::size_t bytes;
};

using ShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;
using Pipeline = Owned<VkPipeline, vkDestroyPipeline>;

// Creates `shader`, which must live until the pipeline is created.
VkPipelineShaderStageCreateInfo loadStage(const Device& device, VkShaderStageFlagBits stage,
                                          const Spirv& code, ShaderModule& shader);

// One set of descriptors, and push constants.
class PushLayout {
public:
  // constants: absent where `size` is 0.
  PushLayout(const Device& device, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
             const VkPushConstantRange& constants = {});

  operator VkPipelineLayout() const { return layout_; }
  void push(VkCommandBuffer commandBuffer, VkPipelineBindPoint point,
            std::span<const VkWriteDescriptorSet> writes) const;

private:
  Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout_;
  Owned<VkPipelineLayout, vkDestroyPipelineLayout> layout_;
  PFN_vkCmdPushDescriptorSetKHR pushDescriptors_;
};

// The writes of one push, with what they point to.
class DescriptorWrites {
public:
  void image(std::uint32_t binding, VkDescriptorType type, VkSampler sampler, const PellucidImage& use) {
    images_.push_back({sampler, use.view, use.layout});
    add(binding, type).pImageInfo = &images_.back();
  }
  void buffer(std::uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo& range) {
    buffers_.push_back(range);
    add(binding, type).pBufferInfo = &buffers_.back();
  }
  const std::vector<VkWriteDescriptorSet>& all() const { return writes_; }

private:
  VkWriteDescriptorSet& add(std::uint32_t binding, VkDescriptorType type) {
    VkWriteDescriptorSet& write =
        writes_.emplace_back(VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET});
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    return write;
  }

  std::deque<VkDescriptorImageInfo> images_;  // a deque's elements stay where they are
  std::deque<VkDescriptorBufferInfo> buffers_;
  std::vector<VkWriteDescriptorSet> writes_;
};

void createPipeline(const Device& device, const PushLayout& layout, const Spirv& compute,
                    const VkSpecializationInfo& constants, Pipeline& pipeline);

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
