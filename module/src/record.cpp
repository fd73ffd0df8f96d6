// Plan -> command buffer. The only file that calls vkCmd*.
#include "context.h"
#include "facts.h"
#include "text.h"
#include "validate.h"

namespace pellucid {
namespace {

const PellucidImage& imageOf(const PellucidFrame& f, uint32_t resource) {
  if (resource >= PELLUCID_RESOURCE_SHADOW0) return f.shadowImages[resource - PELLUCID_RESOURCE_SHADOW0];
  if (resource == PELLUCID_RESOURCE_HISTORY) return f.history;
  if (resource >= PELLUCID_RESOURCE_TRANSIENT0) return f.transients[resource - PELLUCID_RESOURCE_TRANSIENT0];
  switch (resource) {
    case PELLUCID_RESOURCE_FRONT_DEPTH:
      return f.frontDepth;
    case PELLUCID_RESOURCE_BACK_DEPTH:
      return f.backDepth;
    case PELLUCID_RESOURCE_IRRADIANCE:
      return f.irradiance;
    case PELLUCID_RESOURCE_NORMAL:
      return f.normal;
    case PELLUCID_RESOURCE_ALBEDO:
      return f.albedo;
    case PELLUCID_RESOURCE_MATERIAL:
      return f.material;
    default:
      return f.output;
  }
}

void pushBindings(const PellucidContext& c, VkCommandBuffer commandBuffer, const PellucidDispatch& d,
                  const PellucidFrame& f, const PellucidConstantsSlice& slice) {
  VkWriteDescriptorSet writes[PELLUCID_MAX_BINDINGS];
  VkDescriptorImageInfo images[PELLUCID_MAX_BINDINGS];
  VkDescriptorBufferInfo buffers[PELLUCID_MAX_BINDINGS];
  for (uint32_t i = 0; i < d.bindingCount; ++i) {
    const PellucidBinding& b = d.bindings[i];
    writes[i] = VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = b.binding;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = b.type;
    if (b.resource == PELLUCID_RESOURCE_CONSTANTS) {
      buffers[i] = {slice.buffer, slice.offset + b.offset, b.size};
      writes[i].pBufferInfo = &buffers[i];
    } else {
      const PellucidImage& image = imageOf(f, b.resource);
      images[i] = {VK_NULL_HANDLE, image.view, image.layout};
      writes[i].pImageInfo = &images[i];
    }
  }
  c.vk.vkCmdPushDescriptorSetKHR(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, c.pipelineLayout, 0,
                                 d.bindingCount, writes);
}

PellucidResult refuse(const PellucidContext& c, const char* field, const char* sentence) {
  if (c.message) c.message(c.messageUser, PELLUCID_SEVERITY_ERROR, field, sentence);
  return PELLUCID_ERROR_INVALID_ARGUMENT;
}

// Whether the plan was made from such a frame. Before it nothing of the frame is known to be valid.
PellucidResult checkFacts(const PellucidContext& c, const PellucidPlan& plan, const PellucidFrame& f) {
  if ((f.materialCount > 0 && !f.materials) || (f.lightCount > 0 && !f.lights) ||
      (f.shadowMapCount > 0 && !f.shadowMaps) || (f.shadowImageCount > 0 && !f.shadowImages))
    return refuse(c, "frame", "has an array that is NULL, but not its count 0");
  const Facts facts = factsOf(f);
  for (int i = 0; i < PELLUCID_FACT_COUNT; ++i)
    if (facts.hash[i] != plan.facts[i]) {
      char sentence[96];
      Text(sentence, sizeof sentence)
          << "was made from another frame, whose " << nameOf(static_cast<PellucidFact>(i)) << " differs";
      return refuse(c, "plan", sentence);
    }
  return PELLUCID_OK;
}

// Whether the frame has a view of each image that the plan binds.
PellucidResult checkBindings(const PellucidContext& c, const PellucidPlan& plan, const PellucidFrame& f) {
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    for (uint32_t b = 0; b < d.bindingCount; ++b) {
      const uint32_t resource = d.bindings[b].resource;
      if (resource != PELLUCID_RESOURCE_CONSTANTS && imageOf(f, resource).view == VK_NULL_HANDLE)
        return refuse(c, "plan",
                      "uses an image that the frame has no view of: it was made from another frame");
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
  if (!c || !commandBuffer || !plan || !frame || !constants) return PELLUCID_ERROR_INVALID_ARGUMENT;
  if (constants->offset % 256 != 0 || !constants->buffer)
    return refuse(*c, "constants", "needs a buffer and an offset that is a multiple of 256");
  PellucidResult result = checkFacts(*c, *plan, *frame);
  if (result == PELLUCID_OK) result = checkViews(*frame, c->message, c->messageUser);
  if (result == PELLUCID_OK) result = checkBindings(*c, *plan, *frame);
  if (result == PELLUCID_OK)
    result = pellucidWriteConstants(plan, frame, constants->mapped, static_cast<size_t>(constants->size));
  if (result != PELLUCID_OK) return result;

  for (uint32_t i = 0; i < plan->dispatchCount; ++i) {
    const PellucidDispatch& d = plan->dispatches[i];
    if (d.barrierBefore) {
      VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
      barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
      barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
      VkPipelineStageFlags destination = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
      if (d.barrierIndirect) {
        barrier.dstAccessMask |= VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
        destination |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
      }
      c->vk.vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, destination, 0, 1,
                                 &barrier, 0, nullptr, 0, nullptr);
    }
    c->vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, c->pipelines[d.pipeline]);
    pushBindings(*c, commandBuffer, d, *frame, *constants);
    c->vk.vkCmdPushConstants(commandBuffer, c->pipelineLayout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                             PELLUCID_PUSH_CONSTANT_BYTES, d.pushConstants);
    if (d.indirect)
      c->vk.vkCmdDispatchIndirect(commandBuffer, constants->buffer, constants->offset + d.indirectOffset);
    else
      c->vk.vkCmdDispatch(commandBuffer, d.groups[0], d.groups[1], d.groups[2]);
  }
  return PELLUCID_OK;
}
