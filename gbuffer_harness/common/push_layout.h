// Layouts of passes whose descriptors are pushed, and their compute pipelines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "common/device.h"
#include "common/owned.h"
#include "pellucid/pellucid.h"

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
  PushLayout(Device& device, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
             const VkPushConstantRange& constants = {});

  operator VkPipelineLayout() const { return layout_; }
  // On devices that do not push descriptors: for commands of Device::run alone.
  void push(VkCommandBuffer commandBuffer, VkPipelineBindPoint point,
            std::span<const VkWriteDescriptorSet> writes) const;

private:
  Device& device_;
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

}  // namespace pellucid::harness
