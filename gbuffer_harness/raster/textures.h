// The textures of a model in device memory.
#pragma once

#include <memory>
#include <vector>

#include "common/gpu_image.h"
#include "common/owned.h"
#include "raster/model.h"

namespace pellucid::harness {

// Linear colors and vectors in halves, without mip levels.
class UploadedTextures {
public:
  // Throws DeviceError where a texture does not fit the device. The model is not needed afterwards.
  UploadedTextures(Device& device, const Model& model);

  // Index into Model::textures, or white(), a white texel whose sampler needs no filter.
  const GpuImage& image(std::size_t i) const { return *images_[i]; }
  VkSampler sampler(std::size_t i) const { return *samplers_[i]; }
  std::size_t white() const { return images_.size() - 1; }

private:
  void add(Device& device, const Texture& texture, VkFilter filter);

  std::vector<std::unique_ptr<GpuImage>> images_;
  std::vector<std::unique_ptr<Owned<VkSampler, vkDestroySampler>>> samplers_;
};

}  // namespace pellucid::harness
