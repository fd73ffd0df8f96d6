#include "replay/cell_pass.h"

#include <algorithm>

#include "kEngineCells.h"
#include "pellucid/pellucid_thesis.h"

namespace pellucid::harness {
namespace {

constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

// The push constants of shaders/cells.comp.
struct Push {
  std::uint32_t rect[4] = {};
  float depth[4] = {};
  std::uint32_t material[4] = {};
  std::uint32_t blockColumns = 0, firstPixel[2] = {}, viewZ = 0, distances = 0, more = 0;
};

// Camera::depth of the shaders. clip z and w are affine in view z, which is `forward` times the distance.
void setDepth(const float (&m)[16], float (&depth)[4]) {
  const bool perspective = m[11] != 0;
  // Depths of 0..1 of an orthographic camera have their middle in front of the eye.
  const bool forward = perspective ? m[11] > 0 : (0.5f * m[15] - m[14]) / m[10] > 0;
  const float sign = forward ? 1.0f : -1.0f;
  const float values[] = {sign * m[10], m[14], sign * m[11], m[15]};
  std::copy(std::begin(values), std::end(values), depth);
}

Push pushOf(const PellucidFrame& f, const PellucidCells& cells, CellWords words) {
  Push push;
  const std::uint32_t* rect = f.renderRect;
  for (int i = 0; i < 2; ++i) {
    push.rect[i] = rect[i];
    push.rect[2 + i] = rect[2] > 0 ? rect[i] + rect[2 + i] : f.imageExtent[i];
    push.firstPixel[i] = cells.firstPixel[i];
  }
  setDepth(f.clipFromView, push.depth);
  const std::uint32_t mask = f.materialMask == 0 ? UINT32_MAX : f.materialMask;
  push.material[0] = f.materialShift;
  push.material[1] = mask >> f.materialShift & ~(f.thesis ? f.thesis->materialMarkBit : 0);
  push.material[2] = f.materialCount;
  push.blockColumns = cells.blocks[0];
  push.viewZ = f.frontDepthEncoding == PELLUCID_DEPTH_VIEW_Z;
  push.distances = cells.distances;
  push.more = static_cast<std::uint32_t>(words);
  return push;
}

}  // namespace

CellPass::CellPass(Device& device, const PellucidCells& cells, CellWords words)
    : pass_(device, {kEngineCells, sizeof kEngineCells},
            {{kSampled}, {kSampled}, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(Push)),
      cells_(cells),
      words_(words) {}

void CellPass::record(VkCommandBuffer commandBuffer, const PellucidFrame& frame) const {
  const Push push = pushOf(frame, cells_, words_);
  DescriptorWrites writes;
  writes.image(0, kSampled, pass_.sampler(), frame.material);
  writes.image(1, kSampled, pass_.sampler(), frame.frontDepth);
  writes.image(2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_NULL_HANDLE, frame.transients[cells_.transient]);
  // The grid of invocations is one of cells here, not of pixels.
  constexpr std::uint32_t kCells = PELLUCID_CELL_BLOCK_PIXELS / PELLUCID_CELL_PIXELS;
  pass_.record(commandBuffer, writes.all(), static_cast<int>(kCells * cells_.blocks[0]),
               static_cast<int>(kCells * cells_.blocks[1]), &push);
}

}  // namespace pellucid::harness
