// The Vulkan functions the module calls, fetched from the caller: the library never links a loader.
#pragma once

#include <vulkan/vulkan_core.h>

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

// The name of the first function the device does not have, or nullptr when the table is complete.
const char* loadVkTable(PFN_vkGetDeviceProcAddr getDeviceProcAddr, VkDevice device, VkTable* table);

}  // namespace pellucid
