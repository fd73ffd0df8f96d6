#include "pipelines.h"

#include <iterator>

#include "kAddGathered.h"
#include "kAddHistory.h"
#include "kBaseLevel.h"
#include "kDiffuse.h"
#include "kDownsample.h"
#include "kEntryPoints.h"
#include "kEntryPointsArray.h"
#include "kFilterProbes.h"
#include "kFindCells.h"
#include "kListGroups.h"
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
constexpr PellucidSpecialization kFine{PELLUCID_CONSTANT_FINE, 1}, kCoarse{PELLUCID_CONSTANT_FINE, 0};
constexpr PellucidSpecialization kGathered{PELLUCID_CONSTANT_GATHERS, 1};

constexpr PellucidSpecialization kDirectional{PELLUCID_CONSTANT_DIRECTIONAL, 1};
constexpr PellucidSpecialization kShared{PELLUCID_CONSTANT_SHARERS, 2};

constexpr uint32_t kGather = PELLUCID_USE_GATHER, kDiffusion = PELLUCID_USE_DIFFUSION;
constexpr uint32_t kQuality0 = kDiffusion | PELLUCID_USE_QUALITY_0;

// In the order of Pipeline.
const std::array<PipelineDesc, kPipelineCount> kPipelines = {
    desc("translucency", kTranslucency, PELLUCID_USE_TRANSLUCENCY),
    desc("debug_view", kTranslucency, PELLUCID_USE_DEBUG_VIEWS, kDebugViews),
    desc("add_history", kAddHistory, PELLUCID_USE_REUSE),
    desc("find_cells", kFindCells, kDiffusion),
    desc("list_groups", kListGroups, kDiffusion),
    desc("base_level", kBaseLevel, kDiffusion),
    desc("downsample", kDownsample, kDiffusion),
    desc("upsample", kUpsample, kDiffusion),
    desc("diffuse", kDiffuse, kDiffusion, kFine),
    desc("diffuse_gathered", kDiffuse, kDiffusion | kGather, kFine, kGathered),
    desc("diffuse_coarse", kDiffuse, kQuality0, kCoarse),
    desc("diffuse_coarse_gathered", kDiffuse, kQuality0 | kGather, kCoarse, kGathered),
    desc("entry_points", kEntryPoints, kGather),
    desc("entry_points_directional", kEntryPoints, kGather, kDirectional),
    desc("probes", kProbes, kGather),
    desc("probes_directional", kProbes, kGather, kDirectional),
    desc("probes_shared", kProbes, kGather, kShared),
    desc("probes_shared_directional", kProbes, kGather, kDirectional, kShared),
    desc("filter_probes", kFilterProbes, kGather),
    desc("add_gathered", kAddGathered, kGather)};

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
