#include "vk_table.h"

#include <initializer_list>

namespace pellucid {

const char* loadVkTable(PFN_vkGetDeviceProcAddr getDeviceProcAddr, VkDevice device, VkTable* table) {
#define PELLUCID_LOAD(name)                                                     \
  table->name = reinterpret_cast<PFN_##name>(getDeviceProcAddr(device, #name)); \
  if (!table->name) return #name;
  PELLUCID_DEVICE_FUNCTIONS(PELLUCID_LOAD)
#undef PELLUCID_LOAD
  for (const char* name : {"vkCmdPushDescriptorSetKHR", "vkCmdPushDescriptorSet"})
    if (!table->pushDescriptorSet)
      table->pushDescriptorSet =
          reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(getDeviceProcAddr(device, name));
  return nullptr;
}

}  // namespace pellucid
