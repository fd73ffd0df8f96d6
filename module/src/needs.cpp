// The images that a frame's dispatches need, of the caller's and besides.
#include <algorithm>

#include "entry_points.h"
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
  Extent size{parts(f.lattice.extent.x, f.gatherSpacing), parts(f.lattice.extent.y, f.gatherSpacing)};
  // Filtered probes take the place of entry points.
  if (index > pyramid) size.fit(withCoarserEntries(f.lights.entryColumns), f.lights.entryRows);
  return size;
}

// For any render rect: none has more blocks than the whole image.
Extent blocksExtent(const FrameFacts& f) {
  const Blocks blocks(f.lights, {0, 0, f.lattice.extent.x, f.lattice.extent.y});
  return {Blocks::kColumns, parts(blocks.words(), Blocks::kColumns)};
}

// Grows a need to the waves of the plan whose dispatches bind the image: no barrier lies within a wave.
void addUse(const PellucidPlan& plan, uint32_t resource, PellucidImageNeed& need) {
  for (uint32_t d = 0; d < plan.dispatchCount; ++d) {
    const BoundList bound = boundBy(plan, plan.dispatches[d]);
    if (std::none_of(bound.begin(), bound.end(),
                     [&](const PellucidBinding& b) { return b.resource == resource; }))
      continue;
    uint32_t first = d, last = d;
    while (first > 0 && !plan.dispatches[first].barrierBefore) --first;
    while (last + 1 < plan.dispatchCount && !plan.dispatches[last + 1].barrierBefore) ++last;
    need.firstDispatch = std::min(need.firstDispatch, first);
    need.lastDispatch = std::max(need.lastDispatch, last);
  }
}

PellucidResult imageNeeds(const FrameFacts& f, uint32_t* count, PellucidImageNeed* needs) {
  const Stages& stages = f.stages;
  const uint32_t colors = stages.colorTransients(), transients = stages.transients(), room = *count;
  *count = transients + (stages.keepsHistory ? 1 : 0);
  if (!needs) return PELLUCID_OK;
  const uint32_t written = std::min(*count, room);
  for (uint32_t i = 0; i < written; ++i) {
    const bool persistent = i == transients;
    const bool blocks = stages.diffusion && i == stages.blocksTransient();
    const bool texels = persistent ? stages.keepsProbes : i >= colors && !blocks;
    Extent size = blocks   ? blocksExtent(f)
                        : texels ? texelExtent(f, persistent ? stages.pyramidImages() : i - colors)
                                 : Extent{f.frame.imageExtent[0], f.frame.imageExtent[1]};
    // The earlier frame's probes lie above or below this frame's.
    if (persistent && stages.accumulates) size.height *= 2;
    PellucidImageNeed& need = needs[i];
    need = {};
    need.format = blocks ? VK_FORMAT_R32_UINT : texels ? VK_FORMAT_R32G32B32A32_UINT : f.colorFormat;
    need.extent[0] = size.width;
    need.extent[1] = size.height;
    need.bytes = (blocks ? 4ull : texels || f.wide ? 16ull : 8ull) * size.width * size.height;
    need.persistent = persistent;
    need.firstDispatch = UINT32_MAX;
  }
  // With reuse there are frames of two kinds.
  for (const bool reused : {false, true}) {
    if (reused && !stages.keepsHistory) continue;
    PellucidPlan plan{};
    if (!addPasses(f, reused, &plan)) return PELLUCID_ERROR_CAPACITY;
    for (uint32_t i = 0; i < written; ++i)
      addUse(plan, needs[i].persistent ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : kTransient0 + i,
             needs[i]);
  }
  return PELLUCID_OK;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count,
                                                PellucidImageNeed* needs) {
  if (!count) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Findings silent;
  const auto facts = readFrame(frame, silent);
  return facts ? imageNeeds(*facts, count, needs) : silent.result();
}
