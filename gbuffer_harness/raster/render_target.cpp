#include "raster/render_target.h"

#include <bit>
#include <cstring>

#include "common/error.h"

namespace pellucid::harness {

RenderTarget::RenderTarget(Device& device, int width, int height, const std::vector<Color>& colors,
                           std::optional<float> clearDepth, VkFormat depthFormat)
    : device_(device),
      extent_{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
      depthFormat_(depthFormat),
      depthMemory_(device),
      depthImage_(device),
      depthView_(device),
      renderPass_(device),
      framebuffer_(device) {
  std::vector<VkImageView> views;
  for (const Color& color : colors) {
    images_.push_back(
        std::make_unique<GpuImage>(device, width, height, color.format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    views.push_back(images_.back()->use().view);
    clears_.push_back({.color = color.clear});
  }
  if (clearDepth) {
    createDepthBuffer(device);
    views.push_back(depthView_);
    clears_.push_back({.depthStencil = {*clearDepth, 0}});
  }
  createRenderPass(device, colors);
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = renderPass_;
  info.attachmentCount = static_cast<std::uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = extent_.width;
  info.height = extent_.height;
  info.layers = 1;
  check(vkCreateFramebuffer(device.handle(), &info, nullptr, framebuffer_.receive()), "vkCreateFramebuffer");
}

void RenderTarget::createDepthBuffer(Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physicalDevice(), depthFormat_, &properties);
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
    throw DeviceError(device.description() + " has no depth buffers of VkFormat " +
                      std::to_string(depthFormat_));
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = depthFormat_;
  info.extent = {extent_.width, extent_.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check(vkCreateImage(device.handle(), &info, nullptr, depthImage_.receive()), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), depthImage_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(vkAllocateMemory(device.handle(), &allocate, nullptr, depthMemory_.receive()), "vkAllocateMemory");
  check(vkBindImageMemory(device.handle(), depthImage_, depthMemory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = depthImage_;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = depthFormat_;
  view.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(device.handle(), &view, nullptr, depthView_.receive()), "vkCreateImageView");
}

void RenderTarget::createRenderPass(Device& device, const std::vector<Color>& colors) {
  std::vector<VkAttachmentDescription> attachments;
  std::vector<VkAttachmentReference> references;
  const auto attach = [&](VkFormat format, VkAttachmentStoreOp store) {
    references.push_back({static_cast<std::uint32_t>(attachments.size()), VK_IMAGE_LAYOUT_GENERAL});
    VkAttachmentDescription a{};
    a.format = format;
    a.samples = VK_SAMPLE_COUNT_1_BIT;
    a.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    a.storeOp = store;
    a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    attachments.push_back(a);
  };
  for (const Color& color : colors) attach(color.format, VK_ATTACHMENT_STORE_OP_STORE);
  const bool hasDepth = clears_.size() > colors.size();
  if (hasDepth) attach(depthFormat_, VK_ATTACHMENT_STORE_OP_STORE);

  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  subpass.pColorAttachments = references.data();
  if (hasDepth) subpass.pDepthStencilAttachment = &references.back();
  const VkAccessFlags everything = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, all, drawing, everything, everything, 0},
      {0, VK_SUBPASS_EXTERNAL, drawing, all, everything, everything, 0}};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = static_cast<std::uint32_t>(std::size(dependencies));
  info.pDependencies = dependencies;
  check(vkCreateRenderPass(device.handle(), &info, nullptr, renderPass_.receive()), "vkCreateRenderPass");
}

Image RenderTarget::depth() const {
  const std::size_t texels = static_cast<std::size_t>(extent_.width) * extent_.height;
  const std::size_t bytes = depthFormat_ == VK_FORMAT_D16_UNORM ? 2 : 4;
  const HostBuffer staging(device_, texels * bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
  region.imageExtent = {extent_.width, extent_.height, 1};
  device_.run([&](VkCommandBuffer commandBuffer) {
    vkCmdCopyImageToBuffer(commandBuffer, depthImage_, VK_IMAGE_LAYOUT_GENERAL, staging.handle(), 1, &region);
    const VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                 VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &toHost, 0, nullptr, 0, nullptr);
  });
  Image result(static_cast<int>(extent_.width), static_cast<int>(extent_.height), 1);
  const auto* read = static_cast<const unsigned char*>(staging.mapped());
  for (std::size_t i = 0; i < texels; ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, read + i * bytes, bytes);
    result.data[i] = depthFormat_ == VK_FORMAT_D16_UNORM ? static_cast<float>(word) / 65535.0f
                     : depthFormat_ == VK_FORMAT_D32_SFLOAT
                         ? std::bit_cast<float>(word)
                         : static_cast<float>((word & 0xFFFFFFu) / 16777215.0);
  }
  return result;
}

void RenderTarget::begin(VkCommandBuffer commandBuffer) const {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = renderPass_;
  info.framebuffer = framebuffer_;
  info.renderArea.extent = extent_;
  info.clearValueCount = static_cast<std::uint32_t>(clears_.size());
  info.pClearValues = clears_.data();
  vkCmdBeginRenderPass(commandBuffer, &info, VK_SUBPASS_CONTENTS_INLINE);
  const VkViewport viewport{0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height),
                            0, 1};
  const VkRect2D scissor{{0, 0}, extent_};
  vkCmdSetViewport(commandBuffer, 0, 1, &viewport);
  vkCmdSetScissor(commandBuffer, 0, 1, &scissor);
}

}  // namespace pellucid::harness
