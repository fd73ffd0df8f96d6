#include "plan_diffusion.h"

#include <algorithm>
#include <bit>

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
  d->groups[0] = f.blocks.count();
  d->groups[1] = 1;
  b.blocks(d);
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_LISTS, f.constants.lists);
  writeLevel(b, d, kFirstLevel);
  levelTraffic(b, d, kFirstLevel);
  b.pixelInputs(d, source);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 4);
  // The output stands in where nothing is copied.
  b.bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         copies ? copy : static_cast<uint32_t>(PELLUCID_RESOURCE_OUTPUT));
  if (copies) d->modeledBytes += b.colorBytes() * b.pixels();
}

void addListBlocks(PlanBuilder& b) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("list blocks", Pipeline::ListBlocks);
  b.decides();
  d->groups[0] = f.blocks.listGroups();
  d->groups[1] = 1;
  b.blocks(d);
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_LISTS, f.constants.lists);
  // Without a gather it reads none: the lights' window is as large.
  b.constants(
      d, PELLUCID_BINDING_GATHER_MAPS,
      {f.stages.gathered > 0 ? f.constants.gatherMaps.offset : f.constants.shadows.offset, kGatherMapWindow});
}

void addDownsample(PlanBuilder& b, uint32_t finer) {
  PellucidDispatch* d = b.dispatch("downsample", Pipeline::Downsample);
  d->pushConstants[0] = finer;
  if (finer == kFirstLevel) {
    constexpr uint32_t kRowsOfLevel3 = PELLUCID_BLOCK / 8;  // in a block
    b.byBlock(d, PELLUCID_LIST_DOWNSAMPLE, kRowsOfLevel3 / PELLUCID_DOWNSAMPLE_ROWS);
  } else {
    // Shifts round down, as the border's texels begin below 0.
    const auto groups = [&](int32_t first, int32_t size, uint32_t side) {
      const int shift = std::countr_zero(side);
      return static_cast<uint32_t>(((first + size - 1) >> shift) - (first >> shift) + 1);
    };
    const auto& rect = b.facts.pyramid.levels[finer + 2].rect;
    d->pushConstants[1] = groups(rect.x, rect.width, PELLUCID_DOWNSAMPLE_COLUMNS);
    d->groups[0] = d->pushConstants[1] * groups(rect.y, rect.height, PELLUCID_DOWNSAMPLE_ROWS);
    d->groups[1] = 1;
    b.blocks(d);
    b.byList(d, finer == kFirstLevel + 2 ? PELLUCID_LIST_COARSE : PELLUCID_LIST_COARSEST);
  }
  b.constants(d, PELLUCID_BINDING_FRAME, b.facts.constants.frame);
  writeLevel(b, d, finer + 1);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, finer);
  for (uint32_t level = finer; level <= finer + 2; ++level) levelTraffic(b, d, level);
}

void addUpsample(PlanBuilder& b, uint32_t coarsest) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("upsample", Pipeline::Upsample);
  b.byBlock(d, PELLUCID_LIST_UPSAMPLE, 1);
  d->pushConstants[0] = coarsest;
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_KERNELS, f.constants.kernels);
  writeLevel(b, d, kFirstLevel);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, 2);
  readLevel(b, d, PELLUCID_BINDING_COARSER_LEVELS, 4);
  for (uint32_t level = 2; level <= coarsest; ++level) levelTraffic(b, d, level);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
}

void addDiffuse(PlanBuilder& b, uint32_t source, uint32_t destination) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("diffuse", Pipeline::Diffuse);
  b.byBlock(d, PELLUCID_LIST_DIFFUSE,
            PELLUCID_BLOCK / PELLUCID_DIFFUSE_COLUMNS * (PELLUCID_BLOCK / PELLUCID_DIFFUSE_ROWS));
  d->pushConstants[0] = f.stages.gathered > 0 ? f.gatherSpacing : 0;
  d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
  b.common(d, source, destination);
  readLevel(b, d, PELLUCID_BINDING_PYRAMID, kFirstLevel);
  d->modeledBytes += 2 * kTexelBytes * f.pyramid.texels(2);
  if (f.stages.gathered > 0)
    readProbes(b, d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
  else  // stands in
    readLevel(b, d, PELLUCID_BINDING_FILTERED_PROBES, kFirstLevel);
}

}  // namespace pellucid
