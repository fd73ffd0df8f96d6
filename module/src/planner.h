// Puts passes into the order in which they run. Passes are added along the data flow; each goes into the
// earliest wave after all passes with which it shares an image or buffer that one of the two writes. Waves
// are parted by barriers, and the dispatches of one run side by side.
#pragma once

#include <array>

#include "frame.h"
#include "plan.h"

namespace pellucid {

class Planner;

// A dispatch that was added to a plan, until the next one is. Its bindings hold the frame's images, constants
// and transients of those names; a step sets what varies.
class Step {
public:
  Step& push(uint32_t index, uint32_t value);
  // PellucidResource of an image binding that the pass has.
  Step& image(uint32_t binding, uint32_t resource);
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

  // Image of a level of the pyramid. The first holds level 2 after upsampling, too.
  uint32_t level(uint32_t level) const {
    return kTransient0 + facts.stages.colorTransients() + imageOfLevel(level);
  }
  // Images of the gather's probes; of the entry points of the maps and, in their place, the filtered probes.
  uint32_t probes() const {
    return kTransient0 + facts.stages.colorTransients() + facts.stages.pyramidImages();
  }
  uint32_t entryPoints() const { return probes() + 1; }
  uint32_t filteredProbes() const {
    return facts.stages.keepsProbes ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : entryPoints();
  }
  uint32_t blocks() const { return kTransient0 + facts.stages.blocksTransient(); }

  // Orders all that was added. False: there is more than a plan holds.
  bool finish();

private:
  friend class Step;
  // Bits 1 << PellucidResource of all that a dispatch uses, without shadow images, which none writes.
  // CONSTANTS: the lists, which alone of all constants are written.
  struct Access {
    uint32_t reads = 0, writes = 0;
    bool conflicts(const Access& other) const {
      return (writes & (other.reads | other.writes)) != 0 || (reads & other.writes) != 0;
    }
  };
  void addShadowImages(PellucidDispatch& d, std::span<const uint32_t> images);
  Access accessOf(const Pass& pass, const PellucidDispatch& d, BindingSet unused) const;
  uint32_t resourceOf(uint32_t binding) const;

  PellucidPlan& plan_;
  bool fits_ = true;
  uint32_t shadowImages_ = 0;  // of the plan, so far
  std::array<BindingSet, PELLUCID_MAX_DISPATCHES> standIns_{};
};

// Adds the dispatches of the frame to a plan without any; `reused`: an earlier frame's light stands in for
// this frame's. False: they are more than a plan holds, which then has some of them.
bool addPasses(const FrameFacts& facts, bool reused, PellucidPlan* plan);

}  // namespace pellucid
