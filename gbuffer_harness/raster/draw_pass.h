// A render pass over images that others own.
#pragma once

#include <optional>
#include <vector>

#include "common/barrier.h"
#include "common/device.h"
#include "common/owned.h"

namespace pellucid::harness {

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
