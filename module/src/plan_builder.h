// A plan while it is made: its dispatches in the order in which they are asked for, and what they bind.
#pragma once

#include "frame.h"
#include "pipelines.h"

namespace pellucid {

inline constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
inline constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
inline constexpr uint64_t kTexelBytes = 16;  // of the pyramid, as packed by compute/diffusion/texel.glsl
inline constexpr uint64_t kUnknownDepthBytes = 4;  // the module does not know the format; 4 is the common one

struct PlanBuilder {
  PlanBuilder(const FrameFacts& of, PellucidPlan& into) : facts(of), plan(into) {}

  const FrameFacts& facts;
  PellucidPlan& plan;
  bool alongside = false;  // dispatches run beside the one before, with which they share nothing
  bool fits = true;        // all dispatches that were asked for are in the plan
  uint32_t decider = 0;    // the last dispatch so far that writes commands of others

  // The dispatch that was asked for last writes commands of others.
  void decides() { decider = plan.dispatchCount - 1; }

  uint64_t pixels() const { return static_cast<uint64_t>(facts.rect.width) * facts.rect.height; }
  uint64_t colorBytes() const { return facts.wide ? 16 : 8; }

  // Image of a level, see Pyramid. The first holds level 2 after upsampling, too.
  uint32_t pyramidImage(uint32_t level) const {
    return kTransient0 + facts.stages.colorTransients() + (level < 6 ? level / 2 : 1);
  }
  // Images of the gather's probes; of the entry points of the maps and, in their place, the filtered probes.
  uint32_t probesImage() const {
    return kTransient0 + facts.stages.colorTransients() + facts.stages.pyramidImages();
  }
  uint32_t entryPointsImage() const { return probesImage() + 1; }
  uint32_t blocksImage() const { return kTransient0 + facts.stages.blocksTransient(); }
  uint32_t filteredProbesImage() const {
    return facts.stages.keepsProbes ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : entryPointsImage();
  }

  void skip(const char* what, const char* reason);

  // One workgroup for each PELLUCID_GROUP_X x PELLUCID_GROUP_X pixels. Beyond the plan's capacity: one that
  // counts for nothing, and `fits` is false.
  PellucidDispatch* dispatch(const char* name, Pipeline pipeline);

  // `columns`, `rows`: of what one group makes.
  static void groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t columns, uint32_t rows);
  static void groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t tile) {
    groups(d, width, height, tile, tile);
  }
  // The blocks' words, for passes that run by blocks.
  void blocks(PellucidDispatch* d) const;
  // `parts` groups for each block, or with lists for each that a list holds.
  void byBlock(PellucidDispatch* d, uint32_t list, uint32_t parts) const;
  // With lists, as many groups as the GPU counts, at most what the dispatch has.
  void byList(PellucidDispatch* d, uint32_t list) const;

  static void bind(PellucidDispatch* d, uint32_t binding, VkDescriptorType type, uint32_t resource,
                   ConstantsLayout::Range range = {});
  static void constants(PellucidDispatch* d, uint32_t binding, ConstantsLayout::Range range);
  // `bytes`: of a pixel that is read.
  void image(PellucidDispatch* d, uint32_t binding, uint32_t resource, uint64_t bytes) const;
  // An input the frame may lack. The shader's flag keeps it unread, but every statically used binding
  // must hold a view: the front depth stands in.
  void optional(PellucidDispatch* d, uint32_t binding, PellucidResource resource, uint64_t bytes) const;
  // `count`: slots of the pass, PELLUCID_SHADOW_IMAGE_COUNT or PELLUCID_ENTRY_IMAGE_COUNT.
  void shadowImages(PellucidDispatch* d, const LightGroup& group, uint32_t count) const;

  // Images that every pass over pixels reads.
  void pixelInputs(PellucidDispatch* d, uint32_t source) const;
  // Bindings of every pass that writes colors.
  void common(PellucidDispatch* d, uint32_t source, uint32_t destination) const;

private:
  PellucidDispatch beyond_{};
};

}  // namespace pellucid
