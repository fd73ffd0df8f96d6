#include "device_limits.h"

#include "constants_layout.h"
#include "pass.h"
#include "shared/pellucid_shared.h"

namespace pellucid {
namespace {

// Groups have as many invocations, Vulkan promises 128.
constexpr uint32_t kInvocations = 256;
static_assert(kInvocations == PELLUCID_BLOCK_GROUP * PELLUCID_BLOCK_GROUP &&
              kInvocations == PELLUCID_FILTER_GROUP * PELLUCID_FILTER_GROUP &&
              kInvocations == PELLUCID_LIST_GROUP);
// Of the spatial filter, the pass with most; shaders_command_test holds that all have less.
constexpr uint32_t kSharedBytes = 16384;

struct Limit {
  const char* name;
  uint64_t needed, has;
};

// Functions of the instance that say what the device has.
struct Queries {
  PFN_vkGetPhysicalDeviceProperties2 properties;
  PFN_vkGetPhysicalDeviceFeatures features;
  PFN_vkGetPhysicalDeviceFormatProperties format;

  Queries(const PellucidContextDesc& desc, Findings& out) {
    load(desc, "vkGetPhysicalDeviceProperties2", properties, out);
    load(desc, "vkGetPhysicalDeviceFeatures", features, out);
    load(desc, "vkGetPhysicalDeviceFormatProperties", format, out);
  }

private:
  template <class Function>
  static void load(const PellucidContextDesc& desc, const char* name, Function& function, Findings& out) {
    function = reinterpret_cast<Function>(desc.getInstanceProcAddr(desc.instance, name));
    if (!function) out.error("getInstanceProcAddr", "does not find ", name);
  }
};

// Descriptors of a set that are pushed; 0: the device does not say.
uint32_t mostPushed(const PellucidContextDesc& desc, const Queries& get) {
  VkPhysicalDevicePushDescriptorPropertiesKHR pushed{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &pushed, {}};
  get.properties(desc.physicalDevice, &properties);
  return pushed.maxPushDescriptors;
}

bool isStorage(const PellucidContextDesc& desc, const Queries& get, VkFormat format) {
  VkFormatProperties properties{};
  get.format(desc.physicalDevice, format, &properties);
  return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
}

bool writesWithoutFormat(const PellucidContextDesc& desc, const Queries& get) {
  VkPhysicalDeviceFeatures features{};
  get.features(desc.physicalDevice, &features);
  return features.shaderStorageImageWriteWithoutFormat;
}

}  // namespace

void checkLimits(const PellucidContextDesc& desc, const VkPhysicalDeviceProperties& properties,
                 Findings& out) {
  const Queries get(desc, out);
  if (out.result() != PELLUCID_OK) return;
  const VkPhysicalDeviceLimits& l = properties.limits;
  const auto refuse = [&](const char* name, uint64_t has, uint64_t needed) {
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "physicalDevice", properties.deviceName, " has ", name, " ", has,
             "; ", needed, " is required");
  };
  const Limit limits[] = {
      {"maxComputeWorkGroupInvocations", kInvocations, l.maxComputeWorkGroupInvocations},
      {"maxComputeSharedMemorySize", kSharedBytes, l.maxComputeSharedMemorySize},
      {"maxPushConstantsSize", PELLUCID_PUSH_CONSTANT_BYTES, l.maxPushConstantsSize},
      {"maxUniformBufferRange", kShadowWindow, l.maxUniformBufferRange},
      {"maxPerStageDescriptorUniformBuffers", mostBindings(kUniforms), l.maxPerStageDescriptorUniformBuffers},
      {"maxPerStageDescriptorStorageBuffers", mostBindings(kStorage), l.maxPerStageDescriptorStorageBuffers},
      {"maxPerStageDescriptorStorageImages", mostBindings(kStored), l.maxPerStageDescriptorStorageImages},
      {"maxPerStageDescriptorSampledImages", mostBindings(kSampled), l.maxPerStageDescriptorSampledImages},
      {"maxPerStageResources", mostBindings(), l.maxPerStageResources}};
  for (const Limit& limit : limits)
    if (limit.has < limit.needed) return refuse(limit.name, limit.has, limit.needed);
  if (!desc.options.descriptorPools)
    if (const uint32_t most = mostPushed(desc, get); most > 0 && most < mostBindings())
      return refuse("maxPushDescriptors", most, mostBindings());
  // The diffusion's texels, words of blocks, and the output where its format is known.
  for (const VkFormat format : {VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32_UINT, desc.options.outputFormat})
    if (format != VK_FORMAT_UNDEFINED && !isStorage(desc, get, format))
      return out.fail(PELLUCID_ERROR_MISSING_FEATURE, "physicalDevice", properties.deviceName,
                      " has no storage images of VkFormat ", static_cast<int>(format));
  if (desc.options.outputFormat == VK_FORMAT_UNDEFINED && !writesWithoutFormat(desc, get))
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "physicalDevice", properties.deviceName,
             " has no shaderStorageImageWriteWithoutFormat, which outputFormat = UNDEFINED asks for; set the "
             "format of all frames");
}

}  // namespace pellucid
