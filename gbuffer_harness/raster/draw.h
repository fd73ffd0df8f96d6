// The Vulkan objects of drawing a model into images: targets, pipelines and the uploaded triangles.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "raster/model.h"

namespace pellucid::harness {

// A device object destroyed with its owner.
template <class Handle, void (*destroy)(VkDevice, Handle, const VkAllocationCallbacks*)>
class Owned {
public:
  explicit Owned(const Device& device) : device_(device.handle()) {}
  ~Owned() { destroy(device_, handle_, nullptr); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;

  Handle* receive() { return &handle_; }  // for vkCreate*
  operator Handle() const { return handle_; }

private:
  VkDevice device_;
  Handle handle_ = VK_NULL_HANDLE;
};

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

enum class FragmentShader { Surface, Depth, Caster, Count, Transmit };

struct PipelineState {
  FragmentShader shader = FragmentShader::Surface;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  std::optional<VkCompareOp> depthTest;             // writes depth; absent: no depth buffer
  bool add = false;                                 // colors add up instead of replacing
  float depthBiasConstant = 0, depthBiasSlope = 0;  // factors of vkCmdSetDepthBias

  auto operator<=>(const PipelineState&) const = default;
};

// Push constants; shaders/draw.glsl.
struct DrawConstants {
  glm::mat4 clipFromWorld;
  glm::vec4 planar;
  glm::vec4 baseColor;
  glm::vec4 addedColor;
  glm::uvec4 ids;
};
static_assert(sizeof(DrawConstants) == 128, "what every device has for push constants");

// How a model is seen.
struct DrawView {
  Matrix clipFromView, viewFromWorld;
  bool reversedDepth = true;
};

// What a fused dispatch of the module would bind, for FragmentShader::Transmit.
struct PlannedInputs {
  const PellucidDispatch& dispatch;
  const PellucidFrame& frame;  // with its views
  VkBuffer constants;          // the slice that pellucidWriteConstants filled, from offset 0
};

// What an earlier pass drew of the same view.
struct EarlierPass {
  const GpuImage* depth = nullptr;
  const GpuImage* albedoObject = nullptr;  // of shaders/surface.frag
  const PlannedInputs* planned = nullptr;
  const GpuImage* caster = nullptr;  // of shaders/caster.frag, in place of albedoObject
};

// A model in device memory.
class UploadedModel {
public:
  // Throws DeviceError when the device cannot draw or a texture does not fit it. `model` must outlive it.
  UploadedModel(Device& device, const Model& model);

  // Draws every part. Single-sided surfaces get `state.cull`; those that are double-sided too, unless
  // `doubleSidedCull` differs. One submission. Targets of one fragment shader have the same formats.
  void draw(const RenderTarget& target, const DrawView& view, const PipelineState& state,
            VkCullModeFlags doubleSidedCull, const EarlierPass& earlier = {}) const;

private:
  using Pipeline = Owned<VkPipeline, vkDestroyPipeline>;

  VkPipeline pipelineOf(const RenderTarget& target, const PipelineState& state) const;
  void createPipeline(Pipeline& pipeline, const RenderTarget& target, const PipelineState& state) const;
  void createLayout();

  Device& device_;
  const Model& model_;
  HostBuffer vertices_, indices_;
  std::vector<std::unique_ptr<GpuImage>> textures_;  // as Model::textures, and a white one
  std::vector<std::unique_ptr<Owned<VkSampler, vkDestroySampler>>> samplers_;
  Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout_;
  Owned<VkPipelineLayout, vkDestroyPipelineLayout> layout_;
  mutable std::map<PipelineState, Pipeline> pipelines_;  // created where they are drawn with first
  PFN_vkCmdPushDescriptorSetKHR pushDescriptors_ = nullptr;
};

}  // namespace pellucid::harness
