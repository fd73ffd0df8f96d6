#include "raster/draw_pass.h"

#include <iterator>

namespace pellucid::harness {

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

}  // namespace pellucid::harness
