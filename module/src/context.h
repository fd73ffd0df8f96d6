// A context: the pipelines of one device, and the Vulkan functions that the module calls.
#pragma once

#include <array>
#include <span>

#include "findings.h"
#include "pass.h"
#include "pellucid/pellucid_views.h"

namespace pellucid {

#define PELLUCID_DEVICE_FUNCTIONS(X) \
  X(vkCreateDescriptorSetLayout)     \
  X(vkDestroyDescriptorSetLayout)    \
  X(vkCreatePipelineLayout)          \
  X(vkDestroyPipelineLayout)         \
  X(vkCreateShaderModule)            \
  X(vkDestroyShaderModule)           \
  X(vkCreateComputePipelines)        \
  X(vkDestroyPipeline)               \
  X(vkCmdBindPipeline)               \
  X(vkCmdPushConstants)              \
  X(vkCreateDescriptorPool)          \
  X(vkResetDescriptorPool)           \
  X(vkAllocateDescriptorSets)        \
  X(vkUpdateDescriptorSets)          \
  X(vkCmdBindDescriptorSets)         \
  X(vkCmdPipelineBarrier)            \
  X(vkCmdDispatch)                   \
  X(vkCmdDispatchIndirect)

struct VkTable {
#define PELLUCID_MEMBER(name) PFN_##name name = nullptr;
  PELLUCID_DEVICE_FUNCTIONS(PELLUCID_MEMBER)
#undef PELLUCID_MEMBER
  PFN_vkCmdPushDescriptorSetKHR pushDescriptorSet = nullptr;  // of the extension or of Vulkan 1.4; or nullptr
};

}  // namespace pellucid

// Immutable once pellucidCreateContext has returned.
struct PellucidContext {
  VkDevice device = VK_NULL_HANDLE;
  VkAllocationCallbacks allocator{};
  bool hasAllocator = false;
  pellucid::VkTable vk;
  PellucidContextDesc desc{};  // its `allocator` may be gone
  // By pass. A pipeline is NULL that is not among desc.options.uses.
  std::array<VkDescriptorSetLayout, pellucid::kMostPasses> setLayouts{};
  std::array<VkPipelineLayout, pellucid::kMostPasses> pipelineLayouts{};
  std::array<VkPipeline, pellucid::kMostPasses> pipelines{};

  const VkAllocationCallbacks* callbacks() const { return hasAllocator ? &allocator : nullptr; }
};

namespace pellucid {

// Reports a call that failed; the result of that.
PellucidResult vulkanError(Findings& out, const char* call, VkResult result);

// Makes the set and the layout of every pass.
PellucidResult createLayouts(PellucidContext& context, Findings& out);

// Makes the pipelines of the context's uses.
PellucidResult createPipelines(PellucidContext& context, Findings& out);

// Refuses views that cannot be recorded. Errors go to the context's message; `named`: with the view's index
// before the field.
PellucidResult checkViews(const PellucidContext& context, std::span<const PellucidView> views, bool named);

}  // namespace pellucid
