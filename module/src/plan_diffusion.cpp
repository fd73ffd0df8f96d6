#include "plan_diffusion.h"

#include <algorithm>

#include "plan_gather.h"

namespace pellucid {
namespace {

// A level is read or written once.
void levelTraffic(const PlanBuilder& b, PellucidDispatch* d, uint32_t level) {
  d->modeledBytes += kTexelBytes * b.facts.pyramid.texels(level);
}
void readLevel(const PlanBuilder& b, PellucidDispatch* d, uint32_t binding, uint32_t level) {
  b.bind(d, binding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.pyramidImage(level));
}
void writeLevel(const PlanBuilder& b, PellucidDispatch* d, uint32_t level) {
  b.bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.pyramidImage(level));
}

}  // namespace

void addBaseLevel(PlanBuilder& b, uint32_t source, uint32_t copy) {
  const FrameFacts& f = b.facts;
  const bool copies = copy != source;
  PellucidDispatch* d = b.dispatch("base level", Pipeline::BaseLevel);
  d->pushConstants[0] = copies;
  b.listed(d, PELLUCID_LIST_TILES);
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  writeLevel(b, d, kFirstLevel);
  levelTraffic(b, d, kFirstLevel);
  b.pixelInputs(d, source);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 4);
  // The output stands in where nothing is copied.
  b.bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         copies ? copy : static_cast<uint32_t>(PELLUCID_RESOURCE_OUTPUT));
  if (copies) d->modeledBytes += b.colorBytes() * b.pixels();
}

void addDownsample(PlanBuilder& b, uint32_t finer) {
  PellucidDispatch* d = b.dispatch("downsample", Pipeline::Downsample);
  b.listed(d, finer == kFirstLevel ? PELLUCID_LIST_DOWNSAMPLE : PELLUCID_LIST_DOWNSAMPLE_COARSE);
  d->pushConstants[0] = finer;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, b.facts.constants.frame);
  writeLevel(b, d, finer + 1);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, finer);
  for (uint32_t level = finer; level <= finer + 2; ++level) levelTraffic(b, d, level);
}

void addUpsample(PlanBuilder& b, uint32_t coarsest) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("upsample", Pipeline::Upsample);
  b.listed(d, PELLUCID_LIST_UPSAMPLE);
  d->pushConstants[0] = coarsest;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_KERNELS, f.constants.kernels);
  writeLevel(b, d, kFirstLevel);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, 2);
  readLevel(b, d, PELLUCID_BINDING_COARSER_LEVELS, 4);
  for (uint32_t level = 2; level <= std::min(coarsest, 5u); ++level) levelTraffic(b, d, level);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
}

void addDiffuse(PlanBuilder& b, uint32_t source, uint32_t destination, bool addsProbes) {
  const FrameFacts& f = b.facts;
  const bool fine = kQualities[f.quality].fineFilter;
  const Pipeline pipeline = fine ? (addsProbes ? Pipeline::DiffuseGathered : Pipeline::Diffuse)
                                 : (addsProbes ? Pipeline::DiffuseCoarseGathered : Pipeline::DiffuseCoarse);
  // With the gather both are in the plan, and one of them runs.
  const bool skipsLight = f.stages.skipsLight;
  PellucidDispatch* d =
      b.dispatch(skipsLight && !addsProbes ? "diffuse, none gathered" : "diffuse", pipeline);
  b.listed(d, PELLUCID_LIST_DIFFUSE);
  d->pushConstants[1] = 1;  // texels to each side of an edge's that its pixels look at
  d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
  b.common(d, source, destination);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, kFirstLevel);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
  if (addsProbes)
    readProbes(b, d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  else  // stands in
    readLevel(b, d, PELLUCID_BINDING_FILTERED_PROBES, kFirstLevel);
  if (!skipsLight) return;
  if (!addsProbes) d->modeledBytes = 0;  // one of the two runs
  b.indirect(
      d, f.constants.gatherDispatches.offset + (addsProbes ? offsetof(shared::GatherDispatches, light)
                                                           : offsetof(shared::GatherDispatches, noLight)));
}

}  // namespace pellucid
