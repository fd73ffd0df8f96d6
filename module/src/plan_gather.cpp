#include "plan_gather.h"

namespace pellucid {
namespace {

// Cells of the image that the rect touches; each has one probe.
struct Cells {
  uint32_t width, height;

  explicit Cells(const FrameFacts& f)
      : width(cellsAlong(f.rect.x, f.rect.width, f.gatherSpacing)),
        height(cellsAlong(f.rect.y, f.rect.height, f.gatherSpacing)) {}
};

// Groups of `side` x `side` cells in a block.
uint32_t partsOfBlock(const FrameFacts& f, uint32_t side) {
  const uint32_t along = PELLUCID_BLOCK / (side * f.gatherSpacing);
  return along * along;
}

uint64_t entryPointBytes(const LightGroup& group) {
  return kTexelBytes * group.entryColumns * group.entryRows;
}

}  // namespace

void addEntryPoints(PlanBuilder& b, const LightGroup& group) {
  PellucidDispatch* d = b.dispatch("entry points", Pipeline::EntryPoints);
  b.groups(d, group.entryWidth, group.entryHeight, PELLUCID_ENTRY_POINTS_GROUP);
  d->groups[2] = group.shadowCount;
  if (b.facts.stages.lists) {
    d->groups[0] *= d->groups[1] * d->groups[2];
    d->groups[1] = d->groups[2] = 1;
  }
  b.blocks(d);
  b.byList(d, PELLUCID_LIST_ENTRIES);
  d->pushConstants[1] = group.entryColumns | group.entryRows << 16;
  const ConstantsLayout& layout = b.facts.constants;
  b.constants(d, PELLUCID_BINDING_FRAME, layout.frame);
  b.constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
  b.constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
  b.constants(
      d, PELLUCID_BINDING_ENTRY_MAPS,
      {layout.entryMaps.offset + group.entryMapBytes, group.shadowCount * sizeof(shared::EntryMapConstants)});
  b.image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
  b.image(d, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 4);
  b.shadowImages(d, group, PELLUCID_ENTRY_IMAGE_COUNT);
  b.bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.entryPointsImage());
  d->modeledBytes += entryPointBytes(group);
}

void addProbes(PlanBuilder& b, const LightGroup& group, bool adds) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("probes", Pipeline::Probes);
  const Cells cells(f);
  b.byBlock(d, PELLUCID_LIST_PROBES, partsOfBlock(f, PELLUCID_PROBES_GROUP));
  d->pushConstants[0] = f.gatherSpacing;
  d->pushConstants[1] = group.gathered;
  d->pushConstants[2] = group.entryColumns | group.entryRows << 16 | (adds ? 1u << 31 : 0);
  d->pushConstants[3] = f.gatherSamples;
  const ConstantsLayout& layout = f.constants;
  b.constants(d, PELLUCID_BINDING_FRAME, layout.frame);
  b.constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
  b.constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
  b.constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
  b.bind(d, PELLUCID_BINDING_FRONT_DEPTH, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_FRONT_DEPTH);
  b.bind(d, PELLUCID_BINDING_MATERIAL, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_MATERIAL);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 0);
  b.optional(d, PELLUCID_BINDING_BACK_DEPTH, PELLUCID_RESOURCE_BACK_DEPTH, 0);
  b.bind(d, PELLUCID_BINDING_ENTRY_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.entryPointsImage());
  b.bind(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.probesImage());
  // One pixel's depth, material and normal of each cell.
  constexpr uint64_t kCellBytes = kUnknownDepthBytes + 1 + 4 + kTexelBytes;
  d->modeledBytes =
      entryPointBytes(group) + (kCellBytes + (adds ? kTexelBytes : 0)) * cells.width * cells.height;
}

void addSpatialFilter(PlanBuilder& b) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("filter probes", Pipeline::FilterProbes);
  const Cells cells(f);
  b.byBlock(d, PELLUCID_LIST_FILTER, partsOfBlock(f, PELLUCID_FILTER_GROUP));
  d->pushConstants[0] = f.gatherSpacing;
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_MATERIALS, f.constants.materials);
  b.bind(d, PELLUCID_BINDING_ENTRY_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.probesImage());
  b.bind(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.filteredProbesImage());
  d->modeledBytes = 2 * kTexelBytes * cells.width * cells.height;
}

void readProbes(const PlanBuilder& b, PellucidDispatch* d, uint32_t binding, VkDescriptorType type) {
  const Cells cells(b.facts);
  b.bind(d, binding, type, b.filteredProbesImage());
  d->modeledBytes += kTexelBytes * cells.width * cells.height;
}

}  // namespace pellucid
