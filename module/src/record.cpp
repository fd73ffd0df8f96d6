// Plan -> command buffer. The only file that calls vkCmd*.
#include "constants.h"
#include "context.h"
#include "plan_state.h"
#include "validate.h"

namespace pellucid {
namespace {

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

// Refuses frames without what the plan uses, as a plan of another frame has it.
PellucidResult checkPlan(const PellucidContext& c, const PellucidPlan& plan, const FrameFacts& facts) {
  const FrameHash now = hashOf(facts), then = stateOf(plan).frame;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i] != then[i]) {
      char sentence[96];
      Text(sentence, sizeof sentence)
          << "was made from another frame, whose " << nameOf(static_cast<FramePart>(i)) << " differs";
      return refuse(c, "plan", sentence);
    }
  if (c.outputFormat != VK_FORMAT_UNDEFINED && c.outputFormat != facts.frame.outputFormat)
    return refuse(c, "outputFormat",
                  "is not PellucidContextDesc::outputFormat, which the context writes alone");
  if (facts.frame.lightTableCount > 0 && !c.lightTables)
    return refuse(c, "lightTableCount",
                  "is above 0, but PellucidContextDesc::lightTables is 0: the pipelines do not look for any");
  for (uint32_t i = 0; i < facts.frame.shadowMapCount; ++i)
    if (const uint32_t layer = facts.frame.shadowMaps[i].layer;
        layer != 0 && c.shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY) {
      char sentence[96];
      Text(sentence, sizeof sentence) << "is " << layer << ", but PellucidContextDesc::shadowViewType is 2D";
      return refuse(c, Field("shadowMaps[", i, "].layer"), sentence);
    }
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (d.pipeline >= kPipelineCount || c.pipelines[d.pipeline] == VK_NULL_HANDLE) {
      char sentence[128];
      Text(sentence, sizeof sentence) << "needs pipeline " << pellucidPipelineName(d.pipeline)
                                      << ", which PellucidContextDesc::uses leaves out";
      return refuse(c, "plan", sentence);
    }
    for (uint32_t b = 0; b < d.bindingCount; ++b) {
      const uint32_t resource = d.bindings[b].resource;
      const uint32_t slot = d.bindings[b].binding - PELLUCID_BINDING_SHADOW_IMAGES;  // huge before the first
      if (resource == PELLUCID_RESOURCE_FRONT_DEPTH && slot < PELLUCID_SHADOW_IMAGE_COUNT &&
          c.shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY)
        return refuse(c, "shadowImages",
                      "has no view, but PellucidContextDesc::shadowViewType is 2D_ARRAY, and passes bind one "
                      "such view even where no light has a map");
      if (resource != PELLUCID_RESOURCE_CONSTANTS && imageOf(facts.frame, resource).view == VK_NULL_HANDLE)
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
  // Warnings are validation's.
  const auto errors = [](void* user, PellucidSeverity severity, const char* field, const char* message) {
    const auto* context = static_cast<const PellucidContext*>(user);
    if (severity == PELLUCID_SEVERITY_ERROR) refuse(*context, field, message);
  };
  Findings out(errors, const_cast<PellucidContext*>(c));
  FrameFacts facts;
  PellucidResult result = readFrame(frame, out, &facts);
  if (result == PELLUCID_OK) checkViews(facts, out);
  if (out.result() != PELLUCID_OK) return out.result();
  result = checkPlan(*c, *plan, facts);
  if (result == PELLUCID_OK)
    result = writeConstants(facts, *plan, constants->mapped, static_cast<size_t>(constants->size));
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
    pushBindings(*c, commandBuffer, d, facts.frame, *constants);
    c->vk.vkCmdPushConstants(commandBuffer, c->pipelineLayout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                             PELLUCID_PUSH_CONSTANT_BYTES, d.pushConstants);
    if (d.indirect)
      c->vk.vkCmdDispatchIndirect(commandBuffer, constants->buffer, constants->offset + d.indirectOffset);
    else
      c->vk.vkCmdDispatch(commandBuffer, d.groups[0], d.groups[1], d.groups[2]);
  }
  return PELLUCID_OK;
}
