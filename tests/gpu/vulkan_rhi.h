// sample/rhi_pass.h on Vulkan, as RHIs do it: a texture changes its layout with its state.
#pragma once

#include <cstddef>
#include <map>
#include <utility>

#include "common/error.h"
#include "common/gpu_image.h"
#include "common/push_layout.h"
#include "sample/rhi_pass.h"

namespace pellucid::test {

using namespace pellucid::harness;
using namespace pellucid::sample;

class VulkanRhi : public Rhi {
public:
  explicit VulkanRhi(Device& device) : device_(device) {}

  // A texture that dispatches write. All others stay in GENERAL, and are only sampled.
  void own(const GpuImage& image) { textures_[image.use().view] = {image.handle(), kRhiStored}; }
  // Runs what `record` records. Textures begin and end in GENERAL, as GpuImage has them.
  template <class Record>
  void run(Record&& record) {
    device_.run([&](VkCommandBuffer commands) {
      commands_ = commands;
      record();
      for (const auto& [view, texture] : textures_) setState(view, kRhiStored);
      VulkanRhi::commitBarriers();
    });
    textures_.clear();
    buffers_.clear();
  }

  std::unique_ptr<RhiPipeline> createPipeline(std::span<const uint32_t> spirv,
                                              std::span<const PellucidSpecialization> constants,
                                              std::span<const PellucidBinding> slots,
                                              uint32_t pushConstantBytes) override {
    std::vector<VkDescriptorSetLayoutBinding> layout;
    for (const PellucidBinding& b : slots)
      layout.push_back({b.binding, b.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    auto made = std::make_unique<VulkanPipeline>(device_, layout, pushConstantBytes);
    std::vector<VkSpecializationMapEntry> entries;
    for (const PellucidSpecialization& c : constants)
      entries.push_back(
          {c.id, static_cast<uint32_t>(entries.size() * sizeof c + offsetof(PellucidSpecialization, value)),
           sizeof c.value});
    const VkSpecializationInfo info{static_cast<uint32_t>(entries.size()), entries.data(),
                                    constants.size_bytes(), constants.data()};
    harness::createPipeline(device_, made->layout, {spirv.data(), spirv.size_bytes()}, info, made->pipeline);
    return made;
  }

  void setState(RhiTexture texture, RhiState state) override {
    if (!textures_.count(texture)) {
      if (state != kRhiSampled) throw DeviceError("a texture is stored that nobody owns");
    } else if (newTextures_.emplace(texture, state).first->second != state) {
      throw DeviceError("a texture is sampled and stored between two barriers");
    }
  }
  void setState(RhiBuffer buffer, uint32_t states) override { newBuffers_[buffer] = states; }

  void commitBarriers() override {
    VkPipelineStageFlags before = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, after = before;
    std::vector<VkImageMemoryBarrier> images;
    for (const auto& [view, state] : newTextures_) {
      Texture& texture = textures_.at(view);
      if (texture.state == kRhiStored || state == kRhiStored) images.push_back(barrierOf(texture, state));
      texture.state = state;
    }
    std::vector<VkBufferMemoryBarrier> buffers;
    for (const auto& [buffer, states] : newBuffers_) {
      const uint32_t old = std::exchange(buffers_[buffer], states);
      if (old == states && (states & kRhiStored) == 0) continue;
      if (old & kRhiCommands) before |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
      if (states & kRhiCommands) after |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
      buffers.push_back({VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER, nullptr, accessesOf(old),
                         accessesOf(states), VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, buffer, 0,
                         VK_WHOLE_SIZE});
    }
    if (!images.empty() || !buffers.empty())
      vkCmdPipelineBarrier(commands_, before, after, 0, 0, nullptr, static_cast<uint32_t>(buffers.size()),
                           buffers.data(), static_cast<uint32_t>(images.size()), images.data());
    newTextures_.clear();
    newBuffers_.clear();
  }

  void bind(const RhiPipeline& pipeline, std::span<const RhiItem> items,
            std::span<const uint32_t> pushConstants) override {
    const auto& p = static_cast<const VulkanPipeline&>(pipeline);
    if (items.size() != p.slots.size()) throw DeviceError("a set does not have the members of its layout");
    DescriptorWrites writes;
    for (size_t i = 0; i < items.size(); ++i) {
      const RhiItem& item = items[i];
      if (item.slot != p.slots[i].binding || item.type != p.slots[i].descriptorType)
        throw DeviceError("a set does not have the members of its layout");
      const bool readOnly = item.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE && textures_.count(item.texture);
      if (item.buffer)
        writes.buffer(item.slot, item.type, {item.buffer, item.offset, item.size});
      else
        writes.image(item.slot, item.type, VK_NULL_HANDLE,
                     {item.texture, layoutOf(readOnly ? kRhiSampled : kRhiStored)});
    }
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, p.pipeline);
    p.layout.push(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, writes.all());
    vkCmdPushConstants(commands_, p.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       static_cast<uint32_t>(pushConstants.size_bytes()), pushConstants.data());
  }
  void dispatch(const uint32_t (&groups)[3]) override {
    vkCmdDispatch(commands_, groups[0], groups[1], groups[2]);
  }
  void dispatchIndirect(RhiBuffer buffer, VkDeviceSize offset) override {
    vkCmdDispatchIndirect(commands_, buffer, offset);
  }

private:
  struct VulkanPipeline : RhiPipeline {
    VulkanPipeline(Device& device, const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                   uint32_t pushConstantBytes)
        : slots(bindings),
          layout(device, bindings, {VK_SHADER_STAGE_COMPUTE_BIT, 0, pushConstantBytes}),
          pipeline(device) {}
    std::vector<VkDescriptorSetLayoutBinding> slots;
    PushLayout layout;
    Pipeline pipeline;
  };
  struct Texture {
    VkImage image;
    RhiState state;
  };

  static VkImageLayout layoutOf(RhiState state) {
    return state == kRhiSampled ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL;
  }
  static VkAccessFlags accessesOf(uint32_t states) {
    VkAccessFlags accesses = 0;
    if (states & kRhiSampled) accesses |= VK_ACCESS_SHADER_READ_BIT;
    if (states & kRhiStored) accesses |= VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    if (states & kRhiCommands) accesses |= VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
    return accesses;
  }
  static VkImageMemoryBarrier barrierOf(const Texture& texture, RhiState state) {
    return {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
            nullptr,
            accessesOf(texture.state),
            accessesOf(state),
            layoutOf(texture.state),
            layoutOf(state),
            VK_QUEUE_FAMILY_IGNORED,
            VK_QUEUE_FAMILY_IGNORED,
            texture.image,
            {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  }

protected:
  std::map<RhiTexture, RhiState> newTextures_;
  std::map<RhiBuffer, uint32_t> newBuffers_;
  std::map<RhiTexture, Texture> textures_;
  std::map<RhiBuffer, uint32_t> buffers_;

private:
  Device& device_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

}  // namespace pellucid::test
