#include "blocks.h"

#include <bit>

#include "entry_points.h"

namespace pellucid {
namespace {

// The least limit of workgroups along an axis, of all devices.
constexpr uint32_t kMostGroups = 65535;

// Groups of entry points along a side of a map: a bit for each.
constexpr uint32_t kEntryGroups = kEntryColumns / PELLUCID_ENTRY_POINTS_GROUP;
static_assert(kEntryGroups * kEntryGroups <= 32 * PELLUCID_ENTRY_GROUP_WORDS);

// Blocks that pixels [first, first + size) touch. Shifts round down, as the border begins below 0.
uint32_t blocksAlong(uint32_t first, uint32_t size, int border) {
  constexpr int kShift = std::countr_zero(uint32_t{PELLUCID_BLOCK});
  const int begin = static_cast<int>(first) - border, last = static_cast<int>(first + size) - 1 + border;
  return static_cast<uint32_t>((last >> kShift) - (begin >> kShift) + 1);
}

}  // namespace

Blocks::Blocks(const Lights& lights, const Rect& rect)
    : columns(blocksAlong(rect.x, rect.width, PELLUCID_BLOCK_BORDER)),
      rows(blocksAlong(rect.y, rect.height, PELLUCID_BLOCK_BORDER)),
      touched(blocksAlong(rect.x, rect.width, 0) * blocksAlong(rect.y, rect.height, 0)),
      maps(lights.gathered > 0 ? lights.list().front().shadowCount : 0),
      entryGroups(lights.entryColumns * lights.entryRows /
                  (PELLUCID_ENTRY_POINTS_GROUP * PELLUCID_ENTRY_POINTS_GROUP)) {}

uint32_t Blocks::listGroups() const {
  return parts(count() * (1 + kEntryGroups * maps), PELLUCID_LIST_GROUP);
}

const char* whyNoLists(const Inputs& inputs, const Lights& lights, const Blocks& blocks) {
  if (inputs.frame.options.indirectDispatches == 0) return "frame.options.indirectDispatches asks for none";
  if (lights.gathered > 1) return "lights need several dispatches";
  if (blocks.listGroups() > kMostGroups) return "the image has more blocks than lists can hold";
  return nullptr;
}

}  // namespace pellucid
