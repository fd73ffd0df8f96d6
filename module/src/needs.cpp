// The images that the caller creates for a frame: transients, and the persistent image of reuse.
#include <algorithm>

#include "planner.h"

namespace pellucid {
namespace {

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

PellucidImageNeed needOf(const FrameFacts& f, const MadeImage& image, bool persistent) {
  const Extent size = image.extent(f);
  PellucidImageNeed need{};
  need.format = image.texels == Texels::Words    ? VK_FORMAT_R32_UINT
                : image.texels == Texels::Packed ? VK_FORMAT_R32G32B32A32_UINT
                                                 : f.colorFormat;
  const uint64_t texelBytes = image.texels == Texels::Words ? 4 : image.texels == Texels::Colors && !f.wide ? 8 : 16;
  need.extent[0] = size.width, need.extent[1] = size.height;
  need.bytes = texelBytes * size.width * size.height;
  need.persistent = persistent;
  need.firstDispatch = UINT32_MAX;
  return need;
}

PellucidResult imageNeeds(const FrameFacts& f, uint32_t* count, PellucidImageNeed* needs) {
  const uint32_t room = needs ? *count : 0;
  uint32_t made = 0;
  const auto add = [&](const MadeImage& image, bool persistent) {
    if (!image.made(f)) return;
    if (made < room) needs[made] = needOf(f, image, persistent);
    ++made;
  };
  for (const MadeImage* image : transientImages()) add(*image, false);
  for (const MadeImage* image : historyImages()) add(*image, true);
  *count = made;
  // With reuse there are frames of two kinds.
  for (const bool reused : {false, true}) {
    if (room == 0 || (reused && !f.stages.keepsHistory)) continue;
    PellucidPlan plan{};
    if (!addPasses(f, reused, &plan)) return PELLUCID_ERROR_CAPACITY;
    for (uint32_t i = 0; i < std::min(made, room); ++i)
      addUse(plan, needs[i].persistent ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : kTransient0 + i, needs[i]);
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
