// Plays an engine that knows where its materials are, for PELLUCID_INDIRECT_CELLS.
#pragma once

#include "common/pixel_pass.h"
#include "pellucid/pellucid_cells.h"
#include "replay/frame.h"

namespace pellucid::harness {

class CellPass {
public:
  // cells: of the frames that are recorded; `words`: which of them to write.
  CellPass(Device& device, const PellucidCells& cells, CellWords words);

  // Writes the words into the frame's transient, for what is recorded afterwards.
  void record(VkCommandBuffer commandBuffer, const PellucidFrame& frame) const;

private:
  PixelPass pass_;
  PellucidCells cells_;
  CellWords words_;
};

}  // namespace pellucid::harness
