#include "pipelines.h"

#include <iterator>

#include "kAddHistory.h"
#include "kBaseLevel.h"
#include "kDiffuse.h"
#include "kDownsample.h"
#include "kEntryPoints.h"
#include "kEntryPointsArray.h"
#include "kFilterProbes.h"
#include "kListBlocks.h"
#include "kProbes.h"
#include "kTranslucency.h"
#include "kTranslucencyArray.h"
#include "kUpsample.h"
#include "shared/pellucid_shared.h"

namespace pellucid {
namespace {

template <class... Constants, std::size_t N>
constexpr PipelineDesc desc(const char* name, const uint32_t (&words)[N], uint32_t uses,
                            Constants... constants) {
  return {name, words, N, uses, sizeof...(constants), {constants...}};
}

constexpr PellucidSpecialization kDebugViews{PELLUCID_CONSTANT_DEBUG_VIEWS, 1};

constexpr uint32_t kGather = PELLUCID_USE_GATHER, kDiffusion = PELLUCID_USE_DIFFUSION;

// In the order of Pipeline.
const std::array<PipelineDesc, kPipelineCount> kPipelines = {
    desc("translucency", kTranslucency, PELLUCID_USE_TRANSLUCENCY),
    desc("debug_view", kTranslucency, PELLUCID_USE_DEBUG_VIEWS, kDebugViews),
    desc("add_history", kAddHistory, PELLUCID_USE_REUSE),
    desc("base_level", kBaseLevel, kDiffusion),
    desc("list_blocks", kListBlocks, kDiffusion),
    desc("downsample", kDownsample, kDiffusion),
    desc("upsample", kUpsample, kDiffusion),
    desc("diffuse", kDiffuse, kDiffusion),
    desc("entry_points", kEntryPoints, kGather),
    desc("probes", kProbes, kGather),
    desc("filter_probes", kFilterProbes, kGather)};

}  // namespace

PipelineDesc pipelineDesc(uint32_t index, VkImageViewType shadowViewType) {
  PipelineDesc desc = kPipelines[index];
  if (shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY) return desc;
  // Passes that read shadow images.
  if (desc.words == kTranslucency) {
    desc.words = kTranslucencyArray;
    desc.wordCount = std::size(kTranslucencyArray);
  } else if (desc.words == kEntryPoints) {
    desc.words = kEntryPointsArray;
    desc.wordCount = std::size(kEntryPointsArray);
  }
  return desc;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" uint32_t pellucidGetPipelineCount(void) { return kPipelineCount; }

extern "C" const char* pellucidPipelineName(uint32_t pipeline) {
  return pipeline < kPipelineCount ? pipelineDesc(pipeline).name : "unknown pipeline";
}

extern "C" PellucidResult pellucidGetShader(uint32_t pipeline, VkImageViewType shadowViewType,
                                            PellucidShader* shader) {
  const bool known = shadowViewType == VK_IMAGE_VIEW_TYPE_2D || shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  if (pipeline >= kPipelineCount || !known || !shader) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const PipelineDesc p = pipelineDesc(pipeline, shadowViewType);
  *shader = {p.words, p.wordCount, p.constantCount, kPipelines[pipeline].constants.data()};
  return PELLUCID_OK;
}
