// A 2D image with its view and memory, in VK_IMAGE_LAYOUT_GENERAL from its first upload or clear on.
#pragma once

#include <glm/vec3.hpp>

#include "common/device.h"
#include "common/image.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

// A texel of B10G11R11_UFLOAT_PACK32, to the nearest. Finite colors stay so, and what is below 0 becomes 0.
glm::uint32 packB10G11R11(const glm::vec3& color);
glm::vec3 unpackB10G11R11(glm::uint32 word);

class GpuImage {
public:
  // Usable as sampled and storage image, for transfers, and as `more` says. Formats: R32_SFLOAT,
  // R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, R8G8B8A8_SNORM, R8G8B8A8_UNORM, R32_UINT, R32G32B32A32_UINT,
  // B10G11R11_UFLOAT_PACK32; not storage: R32G32_SFLOAT, R16G16_SNORM, A2B10G10R10_UNORM_PACK32,
  // E5B9G9R9_UFLOAT_PACK32, R8_UINT, R8_UNORM, R8G8B8A8_SRGB, which is not for uploads. layers: 0: a 2D view,
  // else a view of all layers of an array.
  GpuImage(Device& device, int width, int height, VkFormat format, VkImageUsageFlags more = 0,
           int layers = 0);
  ~GpuImage();
  GpuImage(const GpuImage&) = delete;
  GpuImage& operator=(const GpuImage&) = delete;

  // Converts to the image's format, which is none of integers. Channels that the source lacks become 0,
  // alpha 1.
  void upload(const Image& source, int layer = 0);
  // R8_UINT, R8_UNORM: bytes as they are stored.
  void upload(const std::vector<std::uint8_t>& source, int layer = 0);
  void upload(const std::vector<std::uint32_t>& source, int layer = 0);  // R32_UINT
  void clear(std::uint8_t byte = 0);                                     // every byte of every texel
  void recordClear(VkCommandBuffer commandBuffer) const;  // with 0, in GENERAL; without barriers
  // Pseudo-random bits; with `most` below 255 bytes of 0 to `most`.
  void fill(std::uint64_t seed, std::uint32_t most = 255);
  // Reads formats that are usable as storage images, R32G32_SFLOAT, R8_UINT, R8_UNORM, R8G8B8A8_SRGB as
  // linear colors, and RGB of A2B10G10R10_UNORM_PACK32.
  Image download() const;
  Image download(const VkRect2D& rect) const;  // of a part

  // How an engine hands it to Pellucid.
  PellucidImage use() const { return {view_, VK_IMAGE_LAYOUT_GENERAL}; }
  VkImage handle() const { return image_; }
  int width() const { return width_; }
  int height() const { return height_; }
  VkFormat format() const { return format_; }

private:
  VkDeviceSize bytes() const { return bytes(width_, height_); }
  VkDeviceSize bytes(int width, int height) const;
  void transfer(const void* source, int layer = 0);
  void copyFrom(VkCommandBuffer commandBuffer, VkBuffer buffer, int layer = 0) const;

  Device& device_;
  int width_, height_;
  VkFormat format_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
};

}  // namespace pellucid::harness
