// Draws what is shown of a frame into a target of the screen's format.
#pragma once

#include <optional>

#include "common/device.h"
#include "common/gpu_image.h"
#include "raster/render_target.h"
#include "view/frames.h"
#include "view/state.h"

namespace pellucid::harness {

// Pixels of the screen, from its top left corner.
struct ScreenRect {
  float x = 0, y = 0, width = 0, height = 0;
};

// The largest rectangle within `area` that has the picture's shape, in its middle.
ScreenRect fitted(const ScreenRect& area, int width, int height);

// The texel of the picture under a position of the screen; none outside of it.
struct Texel {
  int x, y;
};
std::optional<Texel> texelAt(const ScreenRect& picture, int width, int height, float x, float y);

// Values at the ends of the false colors.
struct FalseColors {
  float low = 0, high = 1;
};

// As the display sets them; where it does not, those of the pixels that have a material, with low < high.
FalseColors falseColorsOf(const Display& display, const ViewFrames& frames);

// Rectangle of the legend; empty without false colors.
ScreenRect legendOf(const Display& display, const ScreenRect& picture);

class DisplayPass {
public:
  // For targets like `target`. The device must be able to draw.
  DisplayPass(Device& device, const RenderTarget& target);

  // Within target.begin() and end(). `picture`: where the whole frame is on the screen; only `clip` is drawn.
  // low, high: values at the ends of the false colors.
  void draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, const Display& display, Shown shown,
            const ScreenRect& picture, const ScreenRect& clip, float low, float high) const;

  // Both halves of the picture, and its legend.
  void draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, const Display& display,
            const ScreenRect& picture, const FalseColors& colors) const;

private:
  struct Push {
    float origin[2], extent[2];
    float scale;
    std::int32_t shown, channel;
    float exposure, low, high;
    std::int32_t isLegend, hasTruth, isFalseColor;
  };
  void draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, Shown shown, const Push& push,
            const ScreenRect& clip) const;

  GpuImage white_;  // of one texel, for what a frame does not have
  Owned<VkSampler, vkDestroySampler> sampler_;
  PushLayout layout_;
  Pipeline pipeline_;
};

}  // namespace pellucid::harness
