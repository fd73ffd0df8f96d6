// Plans -> command buffer. The only file that calls vkCmd*.
#include <algorithm>

#include "context.h"
#include "plan.h"

namespace pellucid {
namespace {

// Pushes the dispatch's bindings, or binds a set of the frame's pool.
VkResult bind(const PellucidContext& c, VkCommandBuffer commandBuffer, const PellucidDispatch& d,
              const PellucidView& view) {
  const BoundList bound = boundBy(*view.plan, d);
  const PellucidConstantsSlice& slice = *view.constants;
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (c.desc.options.descriptorPools) {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = view.frame->options.descriptorPool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &c.setLayouts[d.pipeline];
    const VkResult result = c.vk.vkAllocateDescriptorSets(c.device, &info, &set);
    if (result != VK_SUCCESS) return result;
  }
  VkWriteDescriptorSet writes[PELLUCID_MAX_BINDINGS];
  VkDescriptorImageInfo images[PELLUCID_MAX_BINDINGS];
  VkDescriptorBufferInfo buffers[PELLUCID_MAX_BINDINGS];
  for (uint32_t i = 0; i < bound.count; ++i) {
    const PellucidBinding& b = bound.list[i];
    writes[i] = VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstSet = set;  // unused where they are pushed
    writes[i].dstBinding = b.binding;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = b.type;
    if (b.resource == PELLUCID_RESOURCE_CONSTANTS) {
      buffers[i] = {slice.buffer, slice.offset + b.offset, b.size};
      writes[i].pBufferInfo = &buffers[i];
    } else {
      const PellucidImage& image = *imageOf(*view.frame, b.resource);  // checkViews found it
      images[i] = {VK_NULL_HANDLE, image.view, image.layout};
      writes[i].pImageInfo = &images[i];
    }
  }
  if (c.desc.options.descriptorPools) {
    c.vk.vkUpdateDescriptorSets(c.device, bound.count, writes, 0, nullptr);
    c.vk.vkCmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, c.pipelineLayouts[d.pipeline],
                                 0, 1, &set, 0, nullptr);
  } else {
    c.vk.pushDescriptorSet(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, c.pipelineLayouts[d.pipeline], 0,
                           bound.count, writes);
  }
  return VK_SUCCESS;
}

VkResult recordDispatch(const PellucidContext& c, VkCommandBuffer commandBuffer, const PellucidDispatch& d,
                        const PellucidView& view) {
  c.vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, c.pipelines[d.pipeline]);
  const VkResult result = bind(c, commandBuffer, d, view);
  if (result != VK_SUCCESS) return result;
  c.vk.vkCmdPushConstants(commandBuffer, c.pipelineLayouts[d.pipeline], VK_SHADER_STAGE_COMPUTE_BIT, 0,
                          PELLUCID_PUSH_CONSTANT_BYTES, d.pushConstants);
  if (d.indirect)
    c.vk.vkCmdDispatchIndirect(commandBuffer, view.constants->buffer,
                               view.constants->offset + d.indirectOffset);
  else
    c.vk.vkCmdDispatch(commandBuffer, d.groups[0], d.groups[1], d.groups[2]);
  return VK_SUCCESS;
}

void recordBarrier(const PellucidContext& c, VkCommandBuffer commandBuffer, bool indirect) {
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
  VkPipelineStageFlags destination = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
  if (indirect) {
    barrier.dstAccessMask |= VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
    destination |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
  }
  c.vk.vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, destination, 0, 1, &barrier,
                            0, nullptr, 0, nullptr);
}

// Calls each(dispatch) for those of a plan after its first `barriers` barriers and before the next.
template <class Each>
void forSegment(const PellucidPlan& plan, uint32_t barriers, Each&& each) {
  uint32_t before = 0;
  for (uint32_t i = 0; i < plan.dispatchCount && before <= barriers; ++i) {
    if (plan.dispatches[i].barrierBefore) ++before;
    if (before == barriers) each(plan.dispatches[i]);
  }
}

// Counted, because engines may record a part of a plan.
uint32_t barriersOf(const PellucidPlan& plan) {
  return static_cast<uint32_t>(std::count_if(plan.dispatches, plan.dispatches + plan.dispatchCount,
                                             [](const PellucidDispatch& d) { return d.barrierBefore; }));
}

PellucidResult record(const PellucidContext& c, VkCommandBuffer commandBuffer,
                      std::span<const PellucidView> views, bool named) {
  if (const PellucidResult result = checkViews(c, views, named); result != PELLUCID_OK) return result;
  if (c.desc.options.descriptorPools)
    for (const PellucidView& view : views) c.vk.vkResetDescriptorPool(c.device, view.frame->options.descriptorPool, 0);
  uint32_t barriers = 0;
  for (const PellucidView& view : views) barriers = std::max(barriers, barriersOf(*view.plan));
  for (uint32_t segment = 0; segment <= barriers; ++segment) {
    bool indirect = false;
    for (const PellucidView& view : views)
      forSegment(*view.plan, segment,
                 [&](const PellucidDispatch& d) { indirect |= d.barrierBefore && d.barrierIndirect; });
    if (segment > 0) recordBarrier(c, commandBuffer, indirect);
    VkResult result = VK_SUCCESS;
    for (const PellucidView& view : views)
      forSegment(*view.plan, segment, [&](const PellucidDispatch& d) {
        if (result == VK_SUCCESS) result = recordDispatch(c, commandBuffer, d, view);
      });
    // A pool has room for all sets: only the driver's own memory ends.
    if (result != VK_SUCCESS) {
      Findings out(c.desc.message, c.desc.messageUser);
      return vulkanError(out, "vkAllocateDescriptorSets", result);
    }
  }
  return PELLUCID_OK;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidRecordPlan(const PellucidContext* c, VkCommandBuffer commandBuffer,
                                             const PellucidPlan* plan, const PellucidFrame* frame,
                                             const PellucidConstantsSlice* constants) {
  if (!c || !commandBuffer) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const PellucidView view{plan, frame, constants};
  return record(*c, commandBuffer, {&view, 1}, false);
}

extern "C" PellucidResult pellucidRecordViews(const PellucidContext* c, VkCommandBuffer commandBuffer,
                                              uint32_t viewCount, const PellucidView* views) {
  if (!c || !commandBuffer || (viewCount > 0 && !views)) return PELLUCID_ERROR_INVALID_ARGUMENT;
  return record(*c, commandBuffer, {views, viewCount}, true);
}
