#include "raster/depth_buffer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/error.h"

namespace pellucid::harness {

DepthBuffer::DepthBuffer(Device& device, VkExtent2D extent, VkFormat format, int layers)
    : device_(device), extent_(extent), format_(format), memory_(device), image_(device), view_(device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physicalDevice(), format_, &properties);
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
    throw DeviceError(device.description() + " has no depth buffers of VkFormat " + std::to_string(format_));
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format_;
  info.extent = {extent_.width, extent_.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = static_cast<std::uint32_t>(std::max(layers, 1));
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
    info.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  device.share(info);
  check(vkCreateImage(device.handle(), &info, nullptr, image_.receive()), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), image_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(vkAllocateMemory(device.handle(), &allocate, nullptr, memory_.receive()), "vkAllocateMemory");
  check(vkBindImageMemory(device.handle(), image_, memory_, 0), "vkBindImageMemory");
  createView(layers > 0 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, 0, info.arrayLayers, view_);
  for (std::uint32_t i = 0; i < info.arrayLayers; ++i)
    createView(VK_IMAGE_VIEW_TYPE_2D, i, 1, *layers_.emplace_back(std::make_unique<View>(device)));
}

void DepthBuffer::createView(VkImageViewType type, std::uint32_t first, std::uint32_t count,
                             View& view) const {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image_;
  info.viewType = type;
  info.format = format_;
  info.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, first, count};
  check(vkCreateImageView(device_.handle(), &info, nullptr, view.receive()), "vkCreateImageView");
}

Image DepthBuffer::download(int layer, VkImageLayout layout) const {
  const std::size_t texels = static_cast<std::size_t>(extent_.width) * extent_.height;
  const std::size_t bytes = format_ == VK_FORMAT_D16_UNORM ? 2 : 4;
  const HostBuffer staging(device_, texels * bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  VkImageMemoryBarrier readable{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  readable.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  readable.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  readable.oldLayout = layout;
  readable.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  readable.srcQueueFamilyIndex = readable.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  readable.image = image_;
  readable.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, static_cast<std::uint32_t>(layer), 1};
  VkImageMemoryBarrier back = readable;
  std::swap(back.srcAccessMask, back.dstAccessMask);
  std::swap(back.oldLayout, back.newLayout);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, static_cast<std::uint32_t>(layer), 1};
  region.imageExtent = {extent_.width, extent_.height, 1};
  device_.run([&](VkCommandBuffer commandBuffer) {
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                         0, nullptr, 0, nullptr, 1, &readable);
    vkCmdCopyImageToBuffer(commandBuffer, image_, readable.newLayout, staging.handle(), 1, &region);
    const VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                 VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &toHost, 0,
                         nullptr, 1, &back);
  });
  device_.countTransfer(0, texels * bytes);
  Image result(static_cast<int>(extent_.width), static_cast<int>(extent_.height), 1);
  const auto* read = static_cast<const unsigned char*>(staging.mapped());
  for (std::size_t i = 0; i < texels; ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, read + i * bytes, bytes);
    result.data[i] = format_ == VK_FORMAT_D16_UNORM    ? static_cast<float>(word) / 65535.0f
                     : format_ == VK_FORMAT_D32_SFLOAT ? std::bit_cast<float>(word)
                                                       : static_cast<float>((word & 0xFFFFFFu) / 16777215.0);
  }
  return result;
}

}  // namespace pellucid::harness
