// Memory barriers between passes.
#pragma once

#include <vulkan/vulkan.h>

namespace pellucid::harness {

// Stages and accesses on one side of a barrier.
struct Scope {
  VkPipelineStageFlags stages;
  VkAccessFlags accesses;
};
// All of graphics pipelines, and of compute pipelines.
constexpr Scope kDrawing = {
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_SHADER_READ_BIT};
constexpr Scope kComputing = {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                              VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};

inline void barrier(VkCommandBuffer commands, const Scope& before, const Scope& after) {
  const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, before.accesses, after.accesses};
  vkCmdPipelineBarrier(commands, before.stages, after.stages, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

}  // namespace pellucid::harness
