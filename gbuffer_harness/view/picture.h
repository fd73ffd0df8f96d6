// Both halves of the picture, and its legend.
#pragma once

#include <optional>

#include "view/display.h"

namespace pellucid::harness {

// Values at the ends of the false colors.
struct FalseColors {
  float low = 0, high = 1;
};

// The half of the picture that has false colors, the right one first.
std::optional<Shown> falseColored(const Display& display);

// As the display sets them; where it does not, those of the pixels that have a material, with low < high.
FalseColors falseColorsOf(const Display& display, const ViewFrames& frames);

// Rectangle of the legend; empty without false colors.
ScreenRect legendOf(const Display& display, const ScreenRect& picture);

// Within a target's begin() and end(). `picture`: where the frame is on the screen.
void drawPicture(VkCommandBuffer commandBuffer, const DisplayPass& pass, const ViewFrames& frames,
                 const Display& display, const ScreenRect& picture, const FalseColors& colors);

}  // namespace pellucid::harness
