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
  X(vkCmdPushDescriptorSetKHR)       \
  X(vkCmdPipelineBarrier)            \
  X(vkCmdDispatch)                   \
  X(vkCmdDispatchIndirect)

struct VkTable {
#define PELLUCID_MEMBER(name) PFN_##name name = nullptr;
  PELLUCID_DEVICE_FUNCTIONS(PELLUCID_MEMBER)
#undef PELLUCID_MEMBER
};

// The name of the first function the device does not have, or nullptr when the table is complete.
const char* loadVkTable(PFN_vkGetDeviceProcAddr getDeviceProcAddr, VkDevice device, VkTable* table);

}  // namespace pellucid
