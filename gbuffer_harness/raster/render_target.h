// Depth buffers, render passes over images that others own, pipelines that draw with pushed descriptors, and
// images that a model is drawn into.
#pragma once

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "common/barrier.h"
#include "common/device.h"
#include "common/gpu_image.h"
#include "common/image.h"
#include "common/owned.h"
#include "common/pool.h"
#include "common/push_layout.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

// A depth buffer of one layer or several, that passes draw to and shaders read.
class DepthBuffer {
public:
  // format: D16_UNORM, X8_D24_UNORM_PACK32 or D32_SFLOAT. layers: 0: a 2D image, else an array. Throws
  // DeviceError for a format that the device does not draw to.
  DepthBuffer(Device& device, VkExtent2D extent, VkFormat format, int layers = 0);

  VkFormat format() const { return format_; }
  VkExtent2D extent() const { return extent_; }
  std::size_t layers() const { return layers_.size(); }
  VkImageView view() const { return view_; }                      // of all layers
  VkImageView layer(std::size_t i) const { return *layers_[i]; }  // of one, to draw to

  // A layer as it was stored, one channel, 0..1. layout: the one that the image is in, and stays in.
  Image download(int layer = 0, VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL) const;

private:
  using View = Owned<VkImageView, vkDestroyImageView>;

  void createView(VkImageViewType type, std::uint32_t first, std::uint32_t count, View& view) const;

  Device& device_;
  VkExtent2D extent_;
  VkFormat format_;
  Owned<VkDeviceMemory, vkFreeMemory> memory_;
  Owned<VkImage, vkDestroyImage> image_;
  View view_;
  std::vector<std::unique_ptr<View>> layers_;
};

struct Attachment {
  VkImageView view;
  VkFormat format;
  VkClearValue clear;
  VkImageLayout after;  // that the image is in once the pass has run
};

// A render pass over images that others own. Clears, and is ordered after all earlier drawing and computing
// on its images and before all later one: a render graph would say it per image.
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
  struct Shape {
    int width, height;
    std::vector<Color> colors;
    std::optional<float> clearDepth = {};
    VkFormat depthFormat = VK_FORMAT_D32_SFLOAT;  // of that buffer
    bool operator==(const Shape&) const = default;
  };
  // Throws what DepthBuffer throws.
  RenderTarget(Device& device, const Shape& shape);

  GpuImage& image(std::size_t i) const { return *images_[i]; }
  const DrawPass& pass() const { return *pass_; }
  // The depth buffer as it was stored, one channel, 0..1.
  Image depth() const { return depth_->download(); }
  PellucidImage depthUse() const { return {depth_->view(), VK_IMAGE_LAYOUT_GENERAL}; }

  // Clears, and waits for everything before; what is drawn is ready for everything after.
  void begin(VkCommandBuffer commandBuffer) const { pass_->begin(commandBuffer, {{0, 0}, extent_}); }
  void end(VkCommandBuffer commandBuffer) const { vkCmdEndRenderPass(commandBuffer); }

private:
  VkExtent2D extent_;
  std::vector<std::unique_ptr<GpuImage>> images_;
  std::optional<DepthBuffer> depth_;
  std::optional<DrawPass> pass_;
};

// Targets that frames use in turns.
class TargetPool : public Pool<RenderTarget::Shape, const RenderTarget> {
public:
  explicit TargetPool(Device& device) : device_(device) {}

  std::shared_ptr<const RenderTarget> take(const RenderTarget::Shape& shape) {
    return Pool::take(shape, [&] { return std::make_shared<const RenderTarget>(device_, shape); });
  }

private:
  Device& device_;
};

}  // namespace pellucid::harness
