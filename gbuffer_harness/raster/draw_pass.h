// A render pass over images that others own.
#pragma once

#include <optional>
#include <vector>

#include "common/device.h"
#include "common/owned.h"

namespace pellucid::harness {

// Stages and accesses on one side of a barrier.
struct Scope {
  VkPipelineStageFlags stages;
  VkAccessFlags accesses;
};
// All of graphics pipelines, and of compute pipelines.
constexpr Scope kDrawing = {
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_SHADER_READ_BIT};
constexpr Scope kComputing = {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                              VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};

inline void barrier(VkCommandBuffer commands, const Scope& before, const Scope& after) {
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, before.accesses, after.accesses};
  vkCmdPipelineBarrier(commands, before.stages, after.stages, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

struct Attachment {
  VkImageView view;
  VkFormat format;
  VkClearValue clear;
  VkImageLayout after;  // that the image is in once the pass has run
};

// Clears, and is ordered after all earlier drawing and computing on its images and before all later one: a
// render graph would say it per image.
class DrawPass {
public:
  DrawPass(Device& device, VkExtent2D extent, const std::vector<Attachment>& colors,
           const std::optional<Attachment>& depth);

  VkRenderPass renderPass() const { return renderPass_; }
  std::size_t colorCount() const { return colorCount_; }
  VkFormat depthFormat() const { return depthFormat_; }  // UNDEFINED: none

  // Viewport and scissor become the rect, too.
  void begin(VkCommandBuffer commands, const VkRect2D& rect) const;

private:
  std::size_t colorCount_;
  VkFormat depthFormat_ = VK_FORMAT_UNDEFINED;
  std::vector<VkClearValue> clears_;
  Owned<VkRenderPass, vkDestroyRenderPass> renderPass_;
  Owned<VkFramebuffer, vkDestroyFramebuffer> framebuffer_;
};

void setViewport(VkCommandBuffer commands, const VkRect2D& rect);

}  // namespace pellucid::harness
