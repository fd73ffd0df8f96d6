// Images that a model is drawn into.
#pragma once

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/pool.h"
#include "raster/depth_buffer.h"
#include "raster/draw_pass.h"

namespace pellucid::harness {

// Color images of one size, and a depth buffer of its own when `clearDepth` is given.
class RenderTarget {
public:
  struct Color {
    VkFormat format;
    VkClearColorValue clear;
    bool operator==(const Color& other) const {
      return format == other.format &&
             std::equal(std::begin(clear.uint32), std::end(clear.uint32), std::begin(other.clear.uint32));
    }
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
  PellucidImage depthUse() const { return {depth_->view(), VK_IMAGE_LAYOUT_GENERAL}; }

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

// Targets that frames use in turns.
class TargetPool {
public:
  explicit TargetPool(Device& device) : device_(device) {}

  // Arguments and errors are those of RenderTarget.
  std::shared_ptr<const RenderTarget> take(int width, int height,
                                           const std::vector<RenderTarget::Color>& colors,
                                           std::optional<float> clearDepth,
                                           VkFormat depthFormat = VK_FORMAT_D32_SFLOAT) {
    return pool_.take({width, height, colors, clearDepth, depthFormat}, [&] {
      return std::make_shared<const RenderTarget>(device_, width, height, colors, clearDepth, depthFormat);
    });
  }
  void nextFrame() { pool_.nextFrame(); }

private:
  struct Key {
    int width, height;
    std::vector<RenderTarget::Color> colors;
    std::optional<float> clearDepth;
    VkFormat depthFormat;
    bool operator==(const Key&) const = default;
  };
  Device& device_;
  Pool<Key, const RenderTarget> pool_;
};

}  // namespace pellucid::harness
