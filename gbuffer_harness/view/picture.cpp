#include "view/picture.h"

#include <algorithm>
#include <cmath>

namespace pellucid::harness {

std::optional<Shown> falseColored(const Display& display) {
  if (isFalseColor(display.shown)) return display.shown;
  if (display.split && isFalseColor(display.left)) return display.left;
  return std::nullopt;
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

void drawPicture(VkCommandBuffer commandBuffer, const DisplayPass& pass, const ViewFrames& frames,
                 const Display& display, const ScreenRect& picture, const FalseColors& colors) {
  ScreenRect right = picture;
  if (display.split) {
    ScreenRect left = picture;
    left.width = std::round(picture.width * display.splitAt);
    right.x += left.width;
    right.width -= left.width;
    pass.draw(commandBuffer, frames, display, display.left, picture, left, colors.low, colors.high);
  }
  pass.draw(commandBuffer, frames, display, display.shown, picture, right, colors.low, colors.high);
  const ScreenRect legend = legendOf(display, picture);
  if (legend.width > 0) pass.drawLegend(commandBuffer, frames, legend);
}

}  // namespace pellucid::harness
