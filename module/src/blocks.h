// Blocks of 64 x 64 pixels, in which the passes of the diffusion and of the gather run where the GPU finds
// material (compute/frame/blocks.glsl).
#pragma once

#include <cstdint>

#include "lights.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct Blocks {
  uint32_t columns = 0, rows = 0;  // that the rect and PELLUCID_BLOCK_BORDER pixels around touch
  uint32_t touched = 0;            // that the rect touches: no other block holds material
  uint32_t maps = 0;               // shadow maps whose entry points are listed
  uint32_t entryGroups = 0;        // at most, in the list of groups of entry points

  Blocks(const Lights& lights, const Rect& rect);

  uint32_t count() const { return columns * rows; }
  // Where the lists begin in the image of words, and how many words it has.
  uint32_t listWord() const { return PELLUCID_BLOCK_WORDS * count(); }
  uint32_t words() const { return listWord() + 2 * count() + entryGroups; }
  static constexpr uint32_t kColumns = 1u << PELLUCID_BLOCK_WORDS_SHIFT;
  // Groups of the pass that lists blocks: an invocation for each, then for each map, block and row of the
  // map's groups.
  uint32_t listGroups() const;
};

// Why the frame's passes run over all blocks in place of lists, or nullptr. Static string.
const char* whyNoLists(const Inputs& inputs, const Lights& lights, const Blocks& blocks);

}  // namespace pellucid
