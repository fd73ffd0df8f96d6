// A model in device memory.
#pragma once

#include <memory>
#include <vector>

#include "common/gpu_image.h"
#include "common/owned.h"
#include "raster/model.h"

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

}  // namespace pellucid::harness
