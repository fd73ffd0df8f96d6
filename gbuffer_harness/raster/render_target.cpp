#include "raster/render_target.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

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

DrawPass::DrawPass(Device& device, VkExtent2D extent, const std::vector<Attachment>& colors,
                   const std::optional<Attachment>& depth)
    : colorCount_(colors.size()), renderPass_(device), framebuffer_(device) {
  std::vector<VkAttachmentDescription> descriptions;
  std::vector<VkAttachmentReference> references;
  std::vector<VkImageView> views;
  const auto add = [&](const Attachment& a, VkImageLayout drawn) {
    references.push_back({static_cast<std::uint32_t>(views.size()), drawn});
    descriptions.push_back({0, a.format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_CLEAR,
                            VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                            VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_UNDEFINED, a.after});
    views.push_back(a.view);
    clears_.push_back(a.clear);
  };
  for (const Attachment& color : colors) add(color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  if (depth) {
    add(*depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    depthFormat_ = depth->format;
  }
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  subpass.pColorAttachments = references.data();
  if (depth) subpass.pDepthStencilAttachment = &references.back();
  const Scope others = {
      kDrawing.stages | kComputing.stages | VK_PIPELINE_STAGE_TRANSFER_BIT,
      kDrawing.accesses | kComputing.accesses | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
  const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, others.stages, kDrawing.stages, others.accesses, drawn, 0},
      {0, VK_SUBPASS_EXTERNAL, kDrawing.stages, others.stages, drawn, others.accesses, 0}};
  VkRenderPassCreateInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  pass.attachmentCount = static_cast<std::uint32_t>(descriptions.size());
  pass.pAttachments = descriptions.data();
  pass.subpassCount = 1;
  pass.pSubpasses = &subpass;
  pass.dependencyCount = static_cast<std::uint32_t>(std::size(dependencies));
  pass.pDependencies = dependencies;
  check(vkCreateRenderPass(device.handle(), &pass, nullptr, renderPass_.receive()), "vkCreateRenderPass");
  VkFramebufferCreateInfo frame{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  frame.renderPass = renderPass_;
  frame.attachmentCount = static_cast<std::uint32_t>(views.size());
  frame.pAttachments = views.data();
  frame.width = extent.width;
  frame.height = extent.height;
  frame.layers = 1;
  check(vkCreateFramebuffer(device.handle(), &frame, nullptr, framebuffer_.receive()), "vkCreateFramebuffer");
}

void DrawPass::begin(VkCommandBuffer commands, const VkRect2D& rect) const {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = renderPass_;
  info.framebuffer = framebuffer_;
  info.renderArea = rect;
  info.clearValueCount = static_cast<std::uint32_t>(clears_.size());
  info.pClearValues = clears_.data();
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  setViewport(commands, rect);
}

void setViewport(VkCommandBuffer commands, const VkRect2D& rect) {
  const VkViewport viewport{static_cast<float>(rect.offset.x),
                            static_cast<float>(rect.offset.y),
                            static_cast<float>(rect.extent.width),
                            static_cast<float>(rect.extent.height),
                            0,
                            1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &rect);
}

void createPipeline(const Device& device, const DrawPass& pass, const PushLayout& layout, const Spirv& vertex,
                    const Spirv& fragment, const DrawState& state, Pipeline& pipeline) {
  ShaderModule vertexShader(device), fragmentShader(device);
  const VkPipelineShaderStageCreateInfo stages[] = {
      loadStage(device, VK_SHADER_STAGE_VERTEX_BIT, vertex, vertexShader),
      loadStage(device, VK_SHADER_STAGE_FRAGMENT_BIT, fragment, fragmentShader)};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const std::vector<VkPipelineColorBlendAttachmentState> blends(pass.colorCount(), state.blend);
  VkPipelineColorBlendStateCreateInfo colors{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  colors.attachmentCount = static_cast<std::uint32_t>(blends.size());
  colors.pAttachments = blends.data();
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                          VK_DYNAMIC_STATE_DEPTH_BIAS};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = state.depthBiasIsDynamic ? 3 : 2;
  dynamic.pDynamicStates = dynamicStates;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = static_cast<std::uint32_t>(std::size(stages));
  info.pStages = stages;
  info.pVertexInputState = &state.input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &state.raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &state.depth;
  info.pColorBlendState = &colors;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  info.renderPass = pass.renderPass();
  check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline.receive()),
        "vkCreateGraphicsPipelines");
}

RenderTarget::RenderTarget(Device& device, const Shape& shape)
    : extent_{static_cast<std::uint32_t>(shape.width), static_cast<std::uint32_t>(shape.height)} {
  std::vector<Attachment> attachments;
  for (const Color& color : shape.colors) {
    images_.push_back(std::make_unique<GpuImage>(device, shape.width, shape.height, color.format,
                                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    attachments.push_back(
        {images_.back()->use().view, color.format, {.color = color.clear}, VK_IMAGE_LAYOUT_GENERAL});
  }
  std::optional<Attachment> depth;
  if (shape.clearDepth) {
    depth_.emplace(device, extent_, shape.depthFormat);
    depth = {
        depth_->view(), shape.depthFormat, {.depthStencil = {*shape.clearDepth, 0}}, VK_IMAGE_LAYOUT_GENERAL};
  }
  pass_.emplace(device, extent_, attachments, depth);
}

}  // namespace pellucid::harness
