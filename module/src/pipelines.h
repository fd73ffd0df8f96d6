// The pipelines that exist: a pass with its specialization constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pellucid/pellucid.h"

namespace pellucid {

// Indices of PellucidDispatch::pipeline.
enum class Pipeline : uint32_t {
  Translucency,
  DebugView,
  AddHistory,
  BaseLevel,
  ListBlocks,
  Downsample,
  Upsample,
  Diffuse,
  EntryPoints,
  Probes,
  FilterProbes,
  Count
};

constexpr uint32_t kPipelineCount = static_cast<uint32_t>(Pipeline::Count);

struct PipelineDesc {
  const char* name;
  const uint32_t* words;
  std::size_t wordCount;
  uint32_t uses;           // PellucidUse bits, all of which it takes to make it
  uint32_t constantCount;  // of constants
  std::array<PellucidSpecialization, 1> constants;
};

// `index` < kPipelineCount. shadowViewType: PellucidContextDesc's, 2D or 2D_ARRAY.
PipelineDesc pipelineDesc(uint32_t index, VkImageViewType shadowViewType = VK_IMAGE_VIEW_TYPE_2D);

}  // namespace pellucid
