// Puts passes into the order in which they run. Passes are added along the data flow; each goes into the
// earliest wave after all passes with which it shares an image or buffer that one of the two writes. Waves
// are parted by barriers, and the dispatches of one run side by side.
#pragma once

#include <array>
#include <cstring>

#include "frame.h"
#include "plan.h"

namespace pellucid {

enum class Texels : uint8_t {
  Colors,  // FrameFacts::colorFormat
  Packed,  // R32G32B32A32_UINT
  Words    // R32_UINT
};

// An image that passes make and no caller gives: a transient, or options.history.
struct MadeImage {
  Texels texels;
  bool (*made)(const FrameFacts&);      // with or without reuse
  Extent (*extent)(const FrameFacts&);  // of frames with any render rect
};

// All transients, in the order of PellucidFrame::transients. A frame has those whose `made` is true.
std::span<const MadeImage* const> transientImages();
// Images that options.history may hold; a frame keeps one at most.
std::span<const MadeImage* const> historyImages();

class Planner;

// A dispatch that was added to a plan, until the next one is. Its bindings hold the frame's inputs and constants of those names;
// a step sets all others.
class Step {
public:
  // One of the structs of push constants.
  template <class Constants>
  Step& push(const Constants& constants) {
    static_assert(sizeof constants <= PELLUCID_PUSH_CONSTANT_BYTES);
    std::memcpy(d_.pushConstants, &constants, sizeof constants);
    return *this;
  }
  // PellucidResource of an image binding that the pass has.
  Step& image(uint32_t binding, uint32_t resource);
  Step& image(uint32_t binding, const MadeImage& made);
  // The same for a view that the dispatch has, but does not use.
  Step& standIn(uint32_t binding, uint32_t resource);
  // Image that pixels come from, and image that they go to: the output is the frame's last write.
  Step& colors(uint32_t source, uint32_t destination);
  // Windows on the constants and the images of a group's lights, as far as the pass has them.
  Step& lights(const LightGroup& group);

  Step& groups(uint32_t x, uint32_t y = 1, uint32_t z = 1);
  // One workgroup for each `side` x `side` pixels of the rect.
  Step& tiles(uint32_t side);
  // `parts` groups for each block, or with lists for each that the list holds.
  Step& blocks(uint32_t list, uint32_t parts);
  // With lists, as many groups as the GPU counts, at most those that the dispatch has.
  Step& list(uint32_t list);

private:
  friend class Planner;
  Step(Planner& planner, const Pass& pass, PellucidDispatch& dispatch);
  void constants(uint32_t binding, VkDeviceSize offset);

  Planner& planner_;
  const Pass& pass_;
  PellucidDispatch& d_;
};

class Planner {
public:
  Planner(const FrameFacts& of, PellucidPlan& into) : facts(of), plan_(into) {}

  const FrameFacts& facts;

  Step add(const Pass& pass, const char* name);

  // PellucidResource of a transient.
  uint32_t resource(const MadeImage& image) const;

  // Orders all that was added. False: there is more than a plan holds.
  bool finish();

private:
  friend class Step;
  // CONSTANTS: the lists, which alone of all constants are written.
  static constexpr uint32_t kLists = 1u << PELLUCID_RESOURCE_CONSTANTS;
  // Bits 1 << PellucidResource of all that a dispatch uses, without shadow images, which none writes.
  struct Access {
    uint32_t reads = 0, writes = 0;
    bool conflicts(const Access& other) const {
      return (writes & (other.reads | other.writes)) != 0 || (reads & other.writes) != 0;
    }
  };
  void addShadowImages(PellucidDispatch& d, std::span<const uint32_t> images);
  Access accessOf(const Pass& pass, const PellucidDispatch& d, BindingSet unused) const;
  uint32_t inputOf(uint32_t binding) const;

  PellucidPlan& plan_;
  bool fits_ = true;
  uint32_t shadowImages_ = 0;  // of the plan, so far
  std::array<BindingSet, PELLUCID_MAX_DISPATCHES> standIns_{};
};

// Adds the dispatches of the frame to a plan without any; `reused`: an earlier frame's light stands in for
// this frame's. False: they are more than a plan holds, which then has some of them.
bool addPasses(const FrameFacts& facts, bool reused, PellucidPlan* plan);

}  // namespace pellucid
