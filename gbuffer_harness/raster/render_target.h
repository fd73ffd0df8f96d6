// Images that a model is drawn into.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/owned.h"

namespace pellucid::harness {

// Color images of one size, and a depth buffer of its own when `clearDepth` is given.
class RenderTarget {
public:
  struct Color {
    VkFormat format;
    VkClearColorValue clear;
  };
  // depthFormat: of that buffer, D16_UNORM, X8_D24_UNORM_PACK32 or D32_SFLOAT. Throws DeviceError for one
  // that the device does not draw to.
  RenderTarget(Device& device, int width, int height, const std::vector<Color>& colors,
               std::optional<float> clearDepth, VkFormat depthFormat = VK_FORMAT_D32_SFLOAT);

  GpuImage& image(std::size_t i) const { return *images_[i]; }
  VkRenderPass renderPass() const { return renderPass_; }
  VkFormat depthFormat() const { return depthFormat_; }
  std::size_t colorCount() const { return images_.size(); }
  // The depth buffer as it was stored, one channel, 0..1.
  Image depth() const;

  // Clears, and waits for everything before; what is drawn is ready for everything after.
  void begin(VkCommandBuffer commandBuffer) const;
  void end(VkCommandBuffer commandBuffer) const { vkCmdEndRenderPass(commandBuffer); }

private:
  void createDepthBuffer(Device& device);
  void createRenderPass(Device& device, const std::vector<Color>& colors);

  Device& device_;
  VkExtent2D extent_;
  VkFormat depthFormat_;
  std::vector<VkClearValue> clears_;
  std::vector<std::unique_ptr<GpuImage>> images_;
  Owned<VkDeviceMemory, vkFreeMemory> depthMemory_;
  Owned<VkImage, vkDestroyImage> depthImage_;
  Owned<VkImageView, vkDestroyImageView> depthView_;
  Owned<VkRenderPass, vkDestroyRenderPass> renderPass_;
  Owned<VkFramebuffer, vkDestroyFramebuffer> framebuffer_;
};

}  // namespace pellucid::harness
