// Images that a model is drawn into.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "raster/depth_buffer.h"
#include "raster/draw_pass.h"

namespace pellucid::harness {

// Color images of one size, and a depth buffer of its own when `clearDepth` is given.
class RenderTarget {
public:
  struct Color {
    VkFormat format;
    VkClearColorValue clear;
  };
  // depthFormat: of that buffer. Throws what DepthBuffer throws.
  RenderTarget(Device& device, int width, int height, const std::vector<Color>& colors,
               std::optional<float> clearDepth, VkFormat depthFormat = VK_FORMAT_D32_SFLOAT);

  GpuImage& image(std::size_t i) const { return *images_[i]; }
  const DrawPass& pass() const { return *pass_; }
  VkRenderPass renderPass() const { return pass_->renderPass(); }
  VkFormat depthFormat() const { return depthFormat_; }
  // The depth buffer as it was stored, one channel, 0..1.
  Image depth() const { return depth_->download(); }

  // Clears, and waits for everything before; what is drawn is ready for everything after.
  void begin(VkCommandBuffer commandBuffer) const { pass_->begin(commandBuffer, {{0, 0}, extent_}); }
  void end(VkCommandBuffer commandBuffer) const { vkCmdEndRenderPass(commandBuffer); }

private:
  VkExtent2D extent_;
  VkFormat depthFormat_;
  std::vector<std::unique_ptr<GpuImage>> images_;
  std::optional<DepthBuffer> depth_;
  std::optional<DrawPass> pass_;
};

}  // namespace pellucid::harness
