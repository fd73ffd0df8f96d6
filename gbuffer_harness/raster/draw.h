// The Vulkan objects of drawing a model into images: the triangles and textures in device memory, and
// pipelines.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/owned.h"
#include "raster/model.h"
#include "raster/render_target.h"

namespace pellucid::harness {

// Textures are linear colors and vectors in halves, without mip levels.
class UploadedMesh {
public:
  // Throws DeviceError where the device cannot draw or a texture does not fit it. The model is not needed
  // afterwards.
  UploadedMesh(Device& device, const Model& model);

  // Pipelines read locations 0 to 8: the members of Vertex, in their order.
  static VkPipelineVertexInputStateCreateInfo vertexInput();
  void bind(VkCommandBuffer commandBuffer) const;  // vertices and indices

  // Index into Model::textures, or white(), a white texel whose sampler needs no filter.
  const GpuImage& image(std::size_t i) const { return *images_[i]; }
  VkSampler sampler(std::size_t i) const { return *samplers_[i]; }
  std::size_t white() const { return images_.size() - 1; }

private:
  void add(Device& device, const Texture& texture, VkFilter filter);

  HostBuffer vertices_, indices_;
  std::vector<std::unique_ptr<GpuImage>> images_;
  std::vector<std::unique_ptr<Owned<VkSampler, vkDestroySampler>>> samplers_;
};

enum class FragmentShader { Surface, Reflected, Depth, Caster, Count, Transmit };

struct PipelineState {
  FragmentShader shader = FragmentShader::Surface;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  std::optional<VkCompareOp> depthTest;             // writes depth; absent: no depth buffer
  bool add = false;                                 // colors add up instead of replacing
  float depthBiasConstant = 0, depthBiasSlope = 0;  // factors of vkCmdSetDepthBias

  auto operator<=>(const PipelineState&) const = default;
};

// How a model is seen.
struct DrawView {
  Matrix clipFromView, viewFromWorld;
  bool reversedDepth = true;
  // Of orthographic views, scene units: vertices move inward along their normals by this times 1 - cosine to
  // the direction that the view comes from. Not for FragmentShader::Surface and Transmit.
  double normalOffset = 0;
};

// The first dispatch of a plan of the module, a fused one, for FragmentShader::Transmit.
struct PlannedInputs {
  const PellucidPlan& plan;
  const PellucidFrame& frame;  // with its views
  VkBuffer constants;          // the slice that pellucidWriteConstants filled, from offset 0
};

// Images that an earlier pass drew of the view.
struct EarlierPass {
  const GpuImage* depth = nullptr;
  const GpuImage* albedoObject = nullptr;  // of shaders/surface.frag
  const PlannedInputs* planned = nullptr;
  const GpuImage* caster = nullptr;  // objects of shaders/caster.frag, in place of albedoObject
};

// A model in device memory.
class UploadedModel {
public:
  // Throws DeviceError when the device cannot draw or a texture does not fit it. `model` must outlive it.
  UploadedModel(Device& device, const Model& model);

  // Records the drawing of every part. Single-sided surfaces get `state.cull`; those that are double-sided
  // too, unless `doubleSidedCull` differs. Targets of one fragment shader have the same color formats. What
  // the commands read and write must live until they have run.
  void record(VkCommandBuffer commandBuffer, const RenderTarget& target, const DrawView& view,
              const PipelineState& state, VkCullModeFlags doubleSidedCull,
              const EarlierPass& earlier = {}) const;

private:
  class Pipelines;  // all models of a device share them

  const Model& model_;
  UploadedMesh mesh_;
  Pipelines& pipelines_;
};

}  // namespace pellucid::harness
