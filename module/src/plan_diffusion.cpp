#include "plan_diffusion.h"

#include <algorithm>

#include "plan_gather.h"

namespace pellucid {
namespace {

// A level is read or written once.
void levelTraffic(const PlanBuilder& b, PellucidDispatch* d, uint32_t level) {
  d->modeledBytes += kTexelBytes * b.facts.pyramid.texels(level);
}
void readPyramid(const PlanBuilder& b, PellucidDispatch* d) {
  b.bind(d, PELLUCID_BINDING_PYRAMID, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.pyramidImage());
}
void writePyramid(const PlanBuilder& b, PellucidDispatch* d) {
  b.bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.pyramidImage());
}

}  // namespace

void addBaseLevel(PlanBuilder& b, uint32_t source, uint32_t copy) {
  const FrameFacts& f = b.facts;
  const bool copies = copy != source;
  PellucidDispatch* d = b.dispatch("base level", Pipeline::BaseLevel);
  d->pushConstants[0] = copies;
  b.tiles(d);
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  writePyramid(b, d);
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
  const PyramidPlace& place = b.facts.pyramid.levels[finer + 2];
  b.groups(d, static_cast<uint32_t>(place.rect.width), static_cast<uint32_t>(place.rect.height),
           PELLUCID_DOWNSAMPLE_TILE);
  d->pushConstants[0] = finer;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, b.facts.constants.frame);
  writePyramid(b, d);
  readPyramid(b, d);
  for (uint32_t level = finer; level <= finer + 2; ++level) levelTraffic(b, d, level);
}

void addUpsample(PlanBuilder& b, uint32_t coarsest) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("upsample", Pipeline::Upsample);
  // Groups start at texels 32 k - 1, in y 16 k - 1.
  const PyramidPlace& place = f.pyramid.levels[2];
  const auto across = [](int32_t first, int32_t texels, int32_t side) {
    return static_cast<uint32_t>((first + texels) / side - (first + 1) / side + 1);
  };
  d->groups[0] = across(place.rect.x, place.rect.width, 2 * PELLUCID_UPSAMPLE_GROUP);
  d->groups[1] = across(place.rect.y, place.rect.height, PELLUCID_UPSAMPLE_GROUP);
  d->pushConstants[0] = coarsest;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_KERNELS, f.constants.kernels);
  writePyramid(b, d);
  readPyramid(b, d);
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
  // Groups start at texels of level 2, whose rect has a border of one.
  const PyramidPlace& place = f.pyramid.levels[2];
  const auto across = [](int32_t texels, uint32_t side) {
    return (static_cast<uint32_t>(texels) - 2 + side - 1) / side;
  };
  d->groups[0] =
      across(place.rect.width, fine ? PELLUCID_DIFFUSE_TEXELS_X : PELLUCID_DIFFUSE_COARSE_TEXELS_X);
  d->groups[1] = across(place.rect.height, PELLUCID_DIFFUSE_TEXELS_Y);
  d->pushConstants[1] = 1;  // texels to each side of an edge's that its pixels look at
  d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
  b.common(d, source, destination);
  readPyramid(b, d);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
  if (addsProbes)
    readProbes(b, d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  else  // stands in
    b.bind(d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.pyramidImage());
  if (!skipsLight) return;
  if (!addsProbes) d->modeledBytes = 0;  // one of the two runs
  b.indirect(d, addsProbes ? offsetof(shared::GatherDispatches, light)
                           : offsetof(shared::GatherDispatches, noLight));
}

}  // namespace pellucid
