// The images that a frame's dispatches need besides the caller's own.
#include "needs.h"

#include "entry_points.h"
#include "plan.h"
#include "planner.h"

namespace pellucid {
namespace {

struct Extent {
  uint32_t width, height;

  void fit(uint32_t w, uint32_t h) {
    width = std::max(width, w);
    height = std::max(height, h);
  }
};

// Extents of images of packed texels, in their order: the pyramid's, probes, entry points.
Extent texelExtent(const FrameFacts& f, uint32_t index) {
  const uint32_t pyramid = f.stages.pyramidImages();
  if (index < pyramid) return {f.pyramid.images[index].width, f.pyramid.images[index].height};
  Extent size{parts(f.frame.imageExtent[0], f.gatherSpacing), parts(f.frame.imageExtent[1], f.gatherSpacing)};
  // Filtered probes take the place of entry points.
  if (index > pyramid) size.fit(withCoarserEntries(f.lights.entryColumns), f.lights.entryRows);
  return size;
}

// For any render rect: none has more blocks than the whole image.
Extent blocksExtent(const FrameFacts& f) {
  const Blocks blocks(f, {0, 0, f.frame.imageExtent[0], f.frame.imageExtent[1]});
  return {Blocks::kColumns, parts(blocks.words(), Blocks::kColumns)};
}

// The dispatches of the plan that bind the image, with those that run beside them: no barrier lies between.
void addUse(const PellucidPlan& plan, uint32_t resource, PellucidImageNeed& need) {
  need.firstDispatch = UINT32_MAX;
  for (uint32_t d = 0; d < plan.dispatchCount; ++d)
    for (uint32_t b = 0; b < plan.dispatches[d].bindingCount; ++b)
      if (plan.dispatches[d].bindings[b].resource == resource) {
        need.firstDispatch = std::min(need.firstDispatch, d);
        need.lastDispatch = d;
      }
  if (need.firstDispatch > need.lastDispatch) return;  // not in use
  while (need.firstDispatch > 0 && !plan.dispatches[need.firstDispatch].barrierBefore) --need.firstDispatch;
  while (need.lastDispatch + 1 < plan.dispatchCount && !plan.dispatches[need.lastDispatch + 1].barrierBefore)
    ++need.lastDispatch;
}

}  // namespace

PellucidResult imageNeeds(const FrameFacts& f, uint32_t* count, PellucidImageNeed* needs) {
  const Stages& stages = f.stages;
  const uint32_t colors = stages.colorTransients(), transients = stages.transients(), room = *count;
  *count = transients + (stages.keepsHistory ? 1 : 0);
  if (!needs) return PELLUCID_OK;
  // Without a plan before it, that of a frame that refreshes a history: every image is in use.
  PellucidPlan plan;
  const PellucidResult result = buildPlan(f, {}, &plan);
  if (result != PELLUCID_OK) return result;
  // Frames that reuse the history lack the dispatches that refresh it.
  const uint32_t refreshing = stages.keepsProbes ? f.lights.gatherDispatches()
                              : stages.history   ? stages.fused
                                                 : 0;
  for (uint32_t i = 0; i < *count && i < room; ++i) {
    const bool persistent = i == transients;
    const bool blocks = stages.diffusion && i == stages.blocksTransient();
    const bool texels = persistent ? stages.keepsProbes : i >= colors && !blocks;
    const Extent size = blocks   ? blocksExtent(f)
                        : texels ? texelExtent(f, persistent ? stages.pyramidImages() : i - colors)
                                 : Extent{f.frame.imageExtent[0], f.frame.imageExtent[1]};
    PellucidImageNeed& need = needs[i];
    need = {};
    need.format = blocks ? VK_FORMAT_R32_UINT : texels ? VK_FORMAT_R32G32B32A32_UINT : f.colorFormat;
    need.extent[0] = size.width;
    need.extent[1] = size.height;
    need.bytes = (blocks ? 4ull : texels || f.wide ? 16ull : 8ull) * size.width * size.height;
    need.persistent = persistent;
    addUse(plan, persistent ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : kTransient0 + i, need);
    need.firstDispatch -= std::min(need.firstDispatch, refreshing);
  }
  return PELLUCID_OK;
}

}  // namespace pellucid
