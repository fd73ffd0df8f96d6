// Plays an engine that knows where its materials are, for PELLUCID_INDIRECT_CELLS.
#pragma once

#include "common/pixel_pass.h"
#include "pellucid/pellucid_cells.h"
#include "replay/frame.h"

namespace pellucid::harness {

class CellPass {
public:
  explicit CellPass(Device& device);

  // Writes the words that `cells` of the frame asks for into its transient, for what is recorded afterwards.
  void record(VkCommandBuffer commandBuffer, const PellucidFrame& frame, const PellucidCells& cells,
              CellWords words) const;

private:
  PixelPass pass_;
};

}  // namespace pellucid::harness
