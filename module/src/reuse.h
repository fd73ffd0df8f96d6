// Decides if a frame takes the light that came through from an earlier one. Pure.
#pragma once

#include "pellucid/pellucid.h"

namespace pellucid {

struct FrameFacts;

constexpr uint32_t kCoherentLights = 16;

// Content of options.history after a plan has run.
struct History {
  uint32_t valid;  // 0: nothing
  uint32_t age;    // frames since it was written
  VkFormat format;
  uint32_t extent[2], rect[4];
  uint32_t lightCount;               // above kCoherentLights, COHERENCE refreshes every frame
  float lightDots[kCoherentLights];  // camera axis and direction to the light, when written
  uint32_t gatherSpacing;            // of the probes that it holds; 0: it holds the light of pixels
  float preExposure;                 // of the light that it holds
};

// For a frame that keeps its transmitted light: whether `kept`, of the previous plan, stands in for this
// frame's. `now` becomes what the history holds after the frame.
bool decideReuse(const FrameFacts& facts, const History& kept, History* now);

}  // namespace pellucid
