#include "plan_diffusion.h"

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
  PellucidDispatch* d = b.dispatch("quads", !copies  ? PELLUCID_PIPELINE_QUADS
                                            : f.wide ? PELLUCID_PIPELINE_QUADS_AND_COPY_32F
                                                     : PELLUCID_PIPELINE_QUADS_AND_COPY_16F);
  b.tiles(d);
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  writePyramid(b, d);
  levelTraffic(b, d, kFirstLevel);
  b.pixelInputs(d, source);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 4);
  if (copies) {
    b.bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, copy);
    d->modeledBytes += b.colorBytes() * b.pixels();
  }
}

void addDownsample(PlanBuilder& b, uint32_t finer) {
  PellucidDispatch* d = b.dispatch("reduce", PELLUCID_PIPELINE_REDUCE_LEVELS);
  const PyramidPlace& place = b.facts.pyramid.levels[finer + 2];
  b.groups(d, static_cast<uint32_t>(place.rect.width), static_cast<uint32_t>(place.rect.height),
           PELLUCID_REDUCE_TILE);
  d->pushConstants[0] = finer;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, b.facts.constants.frame);
  writePyramid(b, d);
  readPyramid(b, d);
  for (uint32_t level = finer; level <= finer + 2; ++level) levelTraffic(b, d, level);
}

void addUpsample(PlanBuilder& b, uint32_t coarsest, bool makesLast) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch(
      "resolve", makesLast ? PELLUCID_PIPELINE_REDUCE_AND_RESOLVE : PELLUCID_PIPELINE_RESOLVE_LEVELS);
  // Groups start at texels 32 k - 1, in y 16 k - 1.
  const PyramidPlace& place = f.pyramid.levels[2];
  const auto across = [](int32_t first, int32_t texels, int32_t side) {
    return static_cast<uint32_t>((first + texels) / side - (first + 1) / side + 1);
  };
  d->groups[0] = across(place.rect.x, place.rect.width, 2 * PELLUCID_RESOLVE_GROUP);
  d->groups[1] = across(place.rect.y, place.rect.height, PELLUCID_RESOLVE_GROUP);
  d->pushConstants[0] = coarsest;
  d->pushConstants[1] = 16;  // texels under a texel
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_KERNELS, f.constants.kernels);
  writePyramid(b, d);
  readPyramid(b, d);
  for (uint32_t level = 2; level <= (makesLast ? 5 : coarsest); ++level) levelTraffic(b, d, level);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
}

void addDiffuse(PlanBuilder& b, uint32_t source, uint32_t destination, bool addsProbes) {
  const FrameFacts& f = b.facts;
  const bool fine = kQualities[f.quality].fineFilter;
  const uint32_t half =
      fine
          ? (addsProbes ? PELLUCID_PIPELINE_DIFFUSE_GATHER_16F : PELLUCID_PIPELINE_DIFFUSE_16F)
          : (addsProbes ? PELLUCID_PIPELINE_DIFFUSE_COARSE_GATHER_16F : PELLUCID_PIPELINE_DIFFUSE_COARSE_16F);
  // With the gather both are in the plan, and one of them runs.
  const bool skipsLight = f.stages.skipsLight;
  PellucidDispatch* d =
      b.dispatch(skipsLight && !addsProbes ? "diffuse, none gathered" : "diffuse", half + (f.wide ? 1 : 0));
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
  if (addsProbes) readProbes(b, d, PELLUCID_BINDING_SHARED_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  if (!skipsLight) return;
  if (!addsProbes) d->modeledBytes = 0;  // one of the two runs
  b.indirect(d, addsProbes ? offsetof(shared::GatherDispatches, light)
                           : offsetof(shared::GatherDispatches, noLight));
}

}  // namespace pellucid
