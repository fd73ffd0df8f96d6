// A depth buffer of one layer or several, that passes draw to and shaders read.
#pragma once

#include <memory>
#include <vector>

#include "common/device.h"
#include "common/image.h"
#include "common/owned.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

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

}  // namespace pellucid::harness
