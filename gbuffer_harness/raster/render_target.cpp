#include "raster/render_target.h"

namespace pellucid::harness {

RenderTarget::RenderTarget(Device& device, int width, int height, const std::vector<Color>& colors,
                           std::optional<float> clearDepth, VkFormat depthFormat)
    : extent_{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
      depthFormat_(depthFormat) {
  std::vector<Attachment> attachments;
  for (const Color& color : colors) {
    images_.push_back(
        std::make_unique<GpuImage>(device, width, height, color.format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    attachments.push_back(
        {images_.back()->use().view, color.format, {.color = color.clear}, VK_IMAGE_LAYOUT_GENERAL});
  }
  std::optional<Attachment> depth;
  if (clearDepth) {
    depth_.emplace(device, extent_, depthFormat);
    depth = {depth_->view(), depthFormat, {.depthStencil = {*clearDepth, 0}}, VK_IMAGE_LAYOUT_GENERAL};
  }
  pass_.emplace(device, extent_, attachments, depth);
}

}  // namespace pellucid::harness
