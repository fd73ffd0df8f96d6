#include "view/display.h"

#include <algorithm>
#include <cmath>

#include "kDisplayFragment.h"
#include "kDisplayVertex.h"

namespace pellucid::harness {

namespace {

constexpr std::uint32_t kBindings = 6;  // of shaders/display.frag

std::vector<VkDescriptorSetLayoutBinding> layoutBindings() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < kBindings; ++i)
    bindings.push_back(
        {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  return bindings;
}

// The half of the picture that has false colors, the right one first.
std::optional<Shown> falseColored(const Display& display) {
  if (isFalseColor(display.shown)) return display.shown;
  if (display.split && isFalseColor(display.left)) return display.left;
  return std::nullopt;
}

}  // namespace

ScreenRect fitted(const ScreenRect& area, int width, int height) {
  const float scale =
      std::min(area.width / static_cast<float>(width), area.height / static_cast<float>(height));
  const float w = scale * static_cast<float>(width), h = scale * static_cast<float>(height);
  return {std::round(area.x + (area.width - w) / 2), std::round(area.y + (area.height - h) / 2), w, h};
}

std::optional<Texel> texelAt(const ScreenRect& picture, int width, int height, float x, float y) {
  const float u = (x - picture.x) / picture.width, v = (y - picture.y) / picture.height;
  if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return std::nullopt;
  return Texel{static_cast<int>(u * static_cast<float>(width)),
               static_cast<int>(v * static_cast<float>(height))};
}

FalseColors falseColorsOf(const Display& display, const ViewFrames& frames) {
  const std::optional<Shown> shown = falseColored(display);
  if (!shown || display.falseLow != display.falseHigh) return {display.falseLow, display.falseHigh};
  const Image& image = frames.image(*shown);
  const std::vector<std::uint8_t>& material = frames.material();
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t channel = std::min(static_cast<std::size_t>(display.channel), channels - 1);
  float low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const float value = image.data[i * channels + channel];
    if (material[i] == 0 || !(value > -kNoDepth && value < kNoDepth)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return {};
  return {low, low < high ? high : low + 1};
}

ScreenRect legendOf(const Display& display, const ScreenRect& picture) {
  constexpr float kWidth = 14, kFromLeft = 12, kFromTop = 60;
  if (!falseColored(display)) return {};
  return {picture.x + kFromLeft, picture.y + kFromTop, kWidth, std::max(picture.height / 2, 1.0f)};
}

DisplayPass::DisplayPass(Device& device, const RenderTarget& target)
    : white_(device, 1, 1, VK_FORMAT_R32G32B32A32_SFLOAT),
      sampler_(device),
      layout_(device, layoutBindings(), {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)}),
      pipeline_(device) {
  white_.upload(Image(1, 1, 4, 1.0f));
  const VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};  // texels are fetched
  check(vkCreateSampler(device.handle(), &sampler, nullptr, sampler_.receive()), "vkCreateSampler");
  createPipeline(device, target.pass(), layout_, {kDisplayVertex, sizeof kDisplayVertex},
                 {kDisplayFragment, sizeof kDisplayFragment}, {}, pipeline_);
}

void DisplayPass::draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, Shown shown, const Push& push,
                       const ScreenRect& clip) const {
  const PellucidFrame& frame = frames.run(shown).frame();
  const GpuImage* const truth = frames.truth();
  const auto orWhite = [&](const PellucidImage& image) { return image.view ? image : white_.use(); };
  const PellucidImage images[kBindings] = {frame.output,          frame.irradiance,
                                           orWhite(frame.albedo), frame.material,
                                           frame.frontDepth,      truth ? truth->use() : white_.use()};
  DescriptorWrites writes;
  for (std::uint32_t i = 0; i < kBindings; ++i)
    writes.image(i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sampler_, images[i]);
  if (!(clip.width >= 1 && clip.height >= 1)) return;
  const VkViewport viewport{clip.x, clip.y, clip.width, clip.height, 0, 1};
  const VkRect2D scissor{
      {static_cast<std::int32_t>(std::max(clip.x, 0.0f)), static_cast<std::int32_t>(std::max(clip.y, 0.0f))},
      {static_cast<std::uint32_t>(clip.width), static_cast<std::uint32_t>(clip.height)}};
  vkCmdSetViewport(commandBuffer, 0, 1, &viewport);
  vkCmdSetScissor(commandBuffer, 0, 1, &scissor);
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  layout_.push(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, writes.all());
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  vkCmdDraw(commandBuffer, 3, 1, 0, 0);
}

void DisplayPass::draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, const Display& display,
                       Shown shown, const ScreenRect& picture, const ScreenRect& clip, float low,
                       float high) const {
  const Capture& capture = frames.outline();
  Push push{};
  push.origin[0] = picture.x;
  push.origin[1] = picture.y;
  push.extent[0] = static_cast<float>(capture.width);
  push.extent[1] = static_cast<float>(capture.height);
  push.scale = picture.width / push.extent[0];
  push.shown = static_cast<std::int32_t>(shown);
  push.channel = display.channel;
  push.exposure = display.exposure;
  push.low = low;
  push.high = high;
  push.hasTruth = frames.truth() != nullptr;
  push.isFalseColor = isFalseColor(shown);
  draw(commandBuffer, frames, shown, push, clip);
}

void DisplayPass::draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, const Display& display,
                       const ScreenRect& picture, const FalseColors& colors) const {
  ScreenRect right = picture;
  if (display.split) {
    ScreenRect left = picture;
    left.width = std::round(picture.width * display.splitAt);
    right.x += left.width;
    right.width -= left.width;
    draw(commandBuffer, frames, display, display.left, picture, left, colors.low, colors.high);
  }
  draw(commandBuffer, frames, display, display.shown, picture, right, colors.low, colors.high);
  const ScreenRect legend = legendOf(display, picture);
  if (!(legend.width > 0)) return;
  Push push{};
  push.origin[1] = legend.y;
  push.extent[1] = legend.height;
  push.isLegend = 1;
  draw(commandBuffer, frames, Shown::After, push, legend);
}

}  // namespace pellucid::harness
