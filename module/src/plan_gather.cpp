#include "plan_gather.h"

namespace pellucid {
namespace {

// True where the frame is as compute/frame/flags.glsl takes for granted.
bool isDirectional(const FrameFacts& f, const LightGroup& group) {
  return group.directional && f.has(PELLUCID_RESOURCE_NORMAL) &&
         f.frame.frontDepthEncoding == PELLUCID_DEPTH_DEVICE;
}

// Cells of the image that the rect touches; each has one probe.
struct Cells {
  uint32_t width, height;

  explicit Cells(const FrameFacts& f)
      : width(cellsAlong(f.rect.x, f.rect.width, f.gatherSpacing)),
        height(cellsAlong(f.rect.y, f.rect.height, f.gatherSpacing)) {}
};

uint64_t entryPointBytes(const LightGroup& group) {
  return kTexelBytes * group.entryColumns * group.entryRows;
}

}  // namespace

void addEntryPoints(PlanBuilder& b, const LightGroup& group) {
  PellucidDispatch* d =
      b.dispatch("entry points",
                 isDirectional(b.facts, group) ? Pipeline::EntryPointsDirectional : Pipeline::EntryPoints);
  b.groups(d, group.entryWidth, group.entryHeight, PELLUCID_ENTRY_POINTS_GROUP);
  d->groups[2] = group.shadowCount;
  b.goByList(d, PELLUCID_LIST_ENTRY_POINTS, d->groups[0] * d->groups[1] * d->groups[2]);
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
  const bool directional = isDirectional(f, group);
  const Pipeline alone = directional ? Pipeline::ProbesDirectional : Pipeline::Probes;
  const Pipeline shared = directional ? Pipeline::ProbesSharedDirectional : Pipeline::ProbesShared;
  PellucidDispatch* d = b.dispatch("probes", group.gathered > 1 ? shared : alone);
  const Cells cells(f);
  b.listed(d, PELLUCID_LIST_PROBES);
  if (f.stages.skipsLight) b.decides();
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
  b.constants(d, PELLUCID_BINDING_GATHER_DISPATCHES, layout.gatherDispatches);
  // One pixel's depth, material and normal of each cell.
  constexpr uint64_t kCellBytes = kUnknownDepthBytes + 1 + 4 + kTexelBytes;
  d->modeledBytes =
      entryPointBytes(group) + (kCellBytes + (adds ? kTexelBytes : 0)) * cells.width * cells.height;
}

void addSpatialFilter(PlanBuilder& b) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = b.dispatch("filter probes", Pipeline::FilterProbes);
  const Cells cells(f);
  b.listed(d, PELLUCID_LIST_FILTER_PROBES);
  d->pushConstants[0] = f.gatherSpacing;
  b.constants(d, PELLUCID_BINDING_FRAME, f.constants.frame);
  b.constants(d, PELLUCID_BINDING_MATERIALS, f.constants.materials);
  b.bind(d, PELLUCID_BINDING_ENTRY_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, b.probesImage());
  b.bind(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.filteredProbesImage());
  d->modeledBytes = 2 * kTexelBytes * cells.width * cells.height;
  if (f.stages.skipsLight)
    b.indirect(d, f.constants.gatherDispatches.offset + offsetof(shared::GatherDispatches, filterProbes));
}

void readProbes(const PlanBuilder& b, PellucidDispatch* d, uint32_t binding, VkDescriptorType type) {
  const Cells cells(b.facts);
  b.bind(d, binding, type, b.filteredProbesImage());
  d->modeledBytes += kTexelBytes * cells.width * cells.height;
}

}  // namespace pellucid
