// The opaque parts of a plan: packed bindings of its dispatches, and the state that the next frame and records need.
#pragma once

#include <cstring>
#include <type_traits>

#include "images.h"
#include "pass.h"

namespace pellucid {

struct FrameFacts;

// ---- Bindings. A dispatch has a slot for each binding of its pass but shadow images, which lie in
// plan.shadowImages. A slot is an image's resource, or an offset in the constants in steps of 256 bytes.

inline constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
inline constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
inline constexpr VkDeviceSize kSlotBytes = 256;

struct BoundList {
  uint32_t count = 0;
  std::array<PellucidBinding, PELLUCID_MAX_BINDINGS> list;

  const PellucidBinding* begin() const { return list.data(); }
  const PellucidBinding* end() const { return list.data() + count; }
};

// `dispatch`: of the plan, or a copy.
BoundList boundBy(const PellucidPlan& plan, const PellucidDispatch& dispatch);

// ---- State

constexpr uint32_t kCoherentLights = 16;

// Content of options.history after a plan has run.
struct History {
  uint32_t valid;  // 0: nothing
  uint32_t age;    // frames since it was written
  VkFormat format;
  uint32_t extent[2];
  Rect rect;
  uint32_t lightCount;               // above kCoherentLights, COHERENCE refreshes every frame
  float lightDots[kCoherentLights];  // camera axis and direction to the light, when written
  uint32_t gatherSpacing;            // of the probes that it holds; 0: it holds the light of pixels
  uint32_t accumulates;              // 1: probes of two frames, by turns in its halves
  float preExposure;                 // of the light that it holds
  int32_t first[2];                  // of its probes: the image's first pixel
};

// For a frame that keeps its transmitted light: whether `kept`, of the previous plan, stands in for this
// frame's. `now` becomes what the history holds after the frame.
bool decideReuse(const FrameFacts& facts, const History& kept, History* now);

struct PlanState {
  History history{};
  // The earlier frame's, whose probes this frame's are averaged with; valid 0: none.
  struct {
    uint32_t valid;
    float preExposure;
    int32_t first[2];
  } kept{};
  // Facts of the frame that made the plan:
  uint32_t materials = 0;
  Rect rect{};
  VkFormat outputFormat = VK_FORMAT_UNDEFINED;
  uint32_t lightTables = 0;
  uint32_t options = 0;                // PellucidUse bits that pipelines must look for
  uint32_t layeredMap = 0, layer = 0;  // the first map in a layer above 0, plus 1; 0: none
  uint32_t separate = 0;               // 1: output and irradiance share no memory
};
static_assert(sizeof(PlanState) <= sizeof(PellucidPlan::state) && std::is_trivially_copyable_v<PlanState>);

inline PlanState stateOf(const PellucidPlan& plan) {
  PlanState state;
  std::memcpy(static_cast<void*>(&state), plan.state, sizeof state);
  return state;
}

}  // namespace pellucid
