#include "shaders.h"

#include <array>

#include "kAddHistory16f.h"
#include "kAddHistory32f.h"
#include "kDebug16f.h"
#include "kDebug32f.h"
#include "kDiffuse16f.h"
#include "kDiffuse32f.h"
#include "kDiffuseCoarse16f.h"
#include "kDiffuseCoarse32f.h"
#include "kDiffuseCoarseGather16f.h"
#include "kDiffuseCoarseGather32f.h"
#include "kDiffuseGather16f.h"
#include "kDiffuseGather32f.h"
#include "kGather16f.h"
#include "kGather32f.h"
#include "kGatherPoints.h"
#include "kGatherPointsDirectional.h"
#include "kGatherRecords.h"
#include "kGatherRecordsDirectional.h"
#include "kGatherRecordsOneMap.h"
#include "kGatherShare.h"
#include "kQuads.h"
#include "kQuadsAndCopy16f.h"
#include "kQuadsAndCopy32f.h"
#include "kReduce.h"
#include "kReduceAndResolve.h"
#include "kResolve.h"
#include "kTranslucency16f.h"
#include "kTranslucency32f.h"
#include "pellucid/pellucid.h"

namespace pellucid {
namespace {

template <std::size_t N>
constexpr Shader shader(const uint32_t (&words)[N]) {
  return {words, N};
}

// In the order of PellucidPipeline.
const std::array kShaders = {shader(kTranslucency16f),
                             shader(kTranslucency32f),
                             shader(kDebug16f),
                             shader(kDebug32f),
                             shader(kDiffuse16f),
                             shader(kDiffuse32f),
                             shader(kGather16f),
                             shader(kGather32f),

                             shader(kAddHistory16f),
                             shader(kAddHistory32f),
                             shader(kQuadsAndCopy16f),
                             shader(kQuadsAndCopy32f),
                             shader(kQuads),
                             shader(kReduce),
                             shader(kResolve),
                             shader(kDiffuseCoarse16f),
                             shader(kDiffuseCoarse32f),
                             shader(kGatherRecords),
                             shader(kGatherPoints),
                             shader(kGatherShare),
                             shader(kGatherRecordsDirectional),
                             shader(kGatherPointsDirectional),
                             shader(kDiffuseGather16f),
                             shader(kDiffuseGather32f),
                             shader(kDiffuseCoarseGather16f),
                             shader(kDiffuseCoarseGather32f),
                             shader(kGatherRecordsOneMap),
                             shader(kReduceAndResolve)};
static_assert(kShaders.size() == PELLUCID_PIPELINE_COUNT);

}  // namespace

Shader shaderOf(uint32_t pipeline) { return kShaders[pipeline]; }

}  // namespace pellucid

extern "C" PellucidResult pellucidGetShader(uint32_t pipeline, const uint32_t** words, size_t* wordCount) {
  if (pipeline >= PELLUCID_PIPELINE_COUNT || !words || !wordCount) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const pellucid::Shader s = pellucid::shaderOf(pipeline);
  *words = s.words;
  *wordCount = s.wordCount;
  return PELLUCID_OK;
}
