#include "plan_builder.h"

#include <cstddef>

namespace pellucid {

void PlanBuilder::skip(const char* what, const char* reason) {
  for (uint32_t i = 0; i < plan.skipCount; ++i)
    if (plan.skips[i].what == what && plan.skips[i].reason == reason) {
      ++plan.skips[i].count;
      return;
    }
  if (plan.skipCount < PELLUCID_MAX_SKIPS) plan.skips[plan.skipCount++] = {what, reason, 1};
}

PellucidDispatch* PlanBuilder::dispatch(const char* name, Pipeline pipeline) {
  if (plan.dispatchCount == PELLUCID_MAX_DISPATCHES) {
    fits = false;
    beyond_ = {};
    return &beyond_;
  }
  PellucidDispatch& d = plan.dispatches[plan.dispatchCount];
  d.name = name;
  d.pipeline = static_cast<uint32_t>(pipeline);
  groups(&d, facts.rect.width, facts.rect.height, PELLUCID_GROUP_X);
  // Every dispatch after the first reads what the one before wrote, unless it runs beside that.
  // The first of a frame that reuses comes after the last frame's use of the history.
  d.barrierBefore = !alongside && (plan.dispatchCount > 0 || facts.stages.keepsHistory) ? 1 : 0;
  plan.barrierCount += d.barrierBefore;
  ++plan.dispatchCount;
  return &d;
}

void PlanBuilder::groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t columns,
                         uint32_t rows) {
  d->groups[0] = parts(width, columns);
  d->groups[1] = parts(height, rows);
  d->groups[2] = 1;
}

void PlanBuilder::blocks(PellucidDispatch* d) const {
  bind(d, PELLUCID_BINDING_BLOCKS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, blocksImage());
}

void PlanBuilder::byBlock(PellucidDispatch* d, uint32_t list, uint32_t parts) const {
  const bool holdsMaterial =
      list == PELLUCID_LIST_PROBES || list == PELLUCID_LIST_FILTER || list == PELLUCID_LIST_DIFFUSE;
  d->groups[0] = facts.stages.lists && holdsMaterial ? facts.blocks.touched : facts.blocks.count();
  d->groups[1] = parts;
  blocks(d);
  byList(d, list);
}

void PlanBuilder::byList(PellucidDispatch* d, uint32_t list) const {
  if (!facts.stages.lists || !fits) return;
  // The first barrier after the dispatch that lists makes its commands visible to all that follow; others
  // would cost 2 us each.
  PellucidDispatch* waits = plan.dispatches + decider + 1;
  while (waits < d && !waits->barrierBefore) ++waits;
  waits->barrierIndirect = 1;
  d->indirect = 1;
  d->indirectResource = PELLUCID_RESOURCE_CONSTANTS;
  d->indirectOffset =
      facts.constants.lists.offset + offsetof(shared::BlockLists, commands) + list * sizeof(glm::uvec4);
}

void PlanBuilder::bind(PellucidDispatch* d, uint32_t binding, VkDescriptorType type, uint32_t resource,
                       ConstantsLayout::Range range) {
  d->bindings[d->bindingCount++] = {binding, type, resource, 0, range.offset, range.size};
}

void PlanBuilder::constants(PellucidDispatch* d, uint32_t binding, ConstantsLayout::Range range) {
  const bool uniform = binding <= PELLUCID_BINDING_SHADOWS;
  bind(d, binding, uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
       PELLUCID_RESOURCE_CONSTANTS, range);
}

void PlanBuilder::image(PellucidDispatch* d, uint32_t binding, uint32_t resource, uint64_t bytes) const {
  bind(d, binding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, resource);
  d->modeledBytes += bytes * pixels();
}

void PlanBuilder::optional(PellucidDispatch* d, uint32_t binding, PellucidResource resource,
                           uint64_t bytes) const {
  if (facts.has(resource)) return image(d, binding, resource, bytes);
  image(d, binding, PELLUCID_RESOURCE_FRONT_DEPTH, 0);
}

void PlanBuilder::shadowImages(PellucidDispatch* d, const LightGroup& group, uint32_t count) const {
  // Slots that are not read hold a view of the type that shadow images have, as far as the frame has one.
  const PellucidFrame& f = facts.frame;
  const bool some = f.shadowImageCount > 0 && given(f.shadowImages[0]);
  const uint32_t standIn = group.imageCount > 0 ? kShadow0 + group.images[0]
                           : some               ? kShadow0
                                                : static_cast<uint32_t>(PELLUCID_RESOURCE_FRONT_DEPTH);
  constexpr uint32_t kMore[] = {PELLUCID_BINDING_SHADOW_IMAGE_8, PELLUCID_BINDING_SHADOW_IMAGE_9,
                                PELLUCID_BINDING_SHADOW_IMAGE_10, PELLUCID_BINDING_SHADOW_IMAGE_11};
  for (uint32_t slot = 0; slot < count; ++slot) {
    const bool used = slot < group.imageCount;
    const uint32_t binding = slot < PELLUCID_SHADOW_IMAGE_COUNT ? PELLUCID_BINDING_SHADOW_IMAGES + slot
                                                                : kMore[slot - PELLUCID_SHADOW_IMAGE_COUNT];
    image(d, binding, used ? kShadow0 + group.images[slot] : standIn, used ? kUnknownDepthBytes : 0);
  }
}

void PlanBuilder::pixelInputs(PellucidDispatch* d, uint32_t source) const {
  image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
  image(d, PELLUCID_BINDING_SOURCE, source, colorBytes());
  image(d, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
}

void PlanBuilder::common(PellucidDispatch* d, uint32_t source, uint32_t destination) const {
  constants(d, PELLUCID_BINDING_FRAME, facts.constants.frame);
  pixelInputs(d, source);
  const bool last = destination == PELLUCID_RESOURCE_OUTPUT;
  optional(d, PELLUCID_BINDING_ALBEDO, PELLUCID_RESOURCE_ALBEDO, last ? 4 : 0);
  const bool adds = last && facts.frame.outputMode == PELLUCID_OUTPUT_ADD;
  image(d, PELLUCID_BINDING_HELD, adds ? PELLUCID_RESOURCE_OUTPUT : PELLUCID_RESOURCE_FRONT_DEPTH,
        adds ? colorBytes() : 0);
  bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, destination);
  d->modeledBytes += colorBytes() * pixels();
}

}  // namespace pellucid
