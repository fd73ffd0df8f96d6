// Creation of contexts, and what a device must be able to do.
#include "context.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <tuple>

#include "constants.h"

namespace pellucid {

PellucidResult vulkanError(Findings& out, const char* call, VkResult result) {
  const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
  out.fail(memory ? PELLUCID_ERROR_OUT_OF_MEMORY : PELLUCID_ERROR_VULKAN, "device", call,
           " returned VkResult ", static_cast<int>(result));
  return out.result();
}

namespace {

// Groups have as many invocations, Vulkan promises 128.
constexpr uint32_t kInvocations = 256;
static_assert(kInvocations == PELLUCID_BLOCK_GROUP * PELLUCID_BLOCK_GROUP &&
              kInvocations == PELLUCID_FILTER_GROUP * PELLUCID_FILTER_GROUP);
// coarse_levels needs the most shared memory of all passes: 16276 bytes.
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

// Reports the first limit or feature that a context of this description lacks, by its name in Vulkan.
void checkLimits(const PellucidContextDesc& desc, const VkPhysicalDeviceProperties& properties,
                 Findings& out) {
  const Queries get(desc, out);
  if (!out.ok()) return;
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

constexpr uint32_t kAllUses = PELLUCID_USE_TRANSLUCENCY | PELLUCID_USE_GATHER | PELLUCID_USE_DIFFUSION |
                              PELLUCID_USE_REUSE | PELLUCID_USE_DEBUG_VIEWS | PELLUCID_USE_THIN_WALLS |
                              PELLUCID_USE_AMBIENT | PELLUCID_USE_THESIS;

void checkDesc(const PellucidContextDesc& desc, Findings& out) {
  if (desc.headerVersion != PELLUCID_HEADER_VERSION)
    return out.fail(PELLUCID_ERROR_VERSION, "headerVersion", "is ", desc.headerVersion, "; this library has ",
                    PELLUCID_HEADER_VERSION);
  if (!desc.instance || !desc.physicalDevice || !desc.device || !desc.getInstanceProcAddr)
    return out.error(!desc.instance         ? "instance"
                     : !desc.physicalDevice ? "physicalDevice"
                     : !desc.device         ? "device"
                                            : "getInstanceProcAddr",
                     "is NULL");
  if (desc.options.outputFormat != VK_FORMAT_UNDEFINED &&
      desc.options.outputFormat != VK_FORMAT_R16G16B16A16_SFLOAT &&
      desc.options.outputFormat != VK_FORMAT_R32G32B32A32_SFLOAT)
    return out.error("options.outputFormat", "is VkFormat ", static_cast<int>(desc.options.outputFormat),
                     "; R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT and UNDEFINED are possible");
  if (desc.options.shadowViewType != VK_IMAGE_VIEW_TYPE_2D &&
      desc.options.shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY)
    return out.error("options.shadowViewType", "is VkImageViewType ",
                     static_cast<int>(desc.options.shadowViewType), "; 2D and 2D_ARRAY are possible");
  const std::tuple<const char*, uint32_t, uint32_t> mosts[] = {
      {"options.lightTables", desc.options.lightTables, 1},
      {"options.descriptorPools", desc.options.descriptorPools, 1}};
  for (const auto& [field, value, most] : mosts)
    if (value > most) return out.error(field, "is ", value, ", outside 0..", most);
  if (desc.options.uses & ~kAllUses)
    return out.error("options.uses", "has unknown bits ", desc.options.uses & ~kAllUses);
  if (desc.apiVersion < VK_API_VERSION_1_1)
    return out.fail(PELLUCID_ERROR_MISSING_FEATURE, "apiVersion", "is ",
                    VK_API_VERSION_MAJOR(desc.apiVersion), ".", VK_API_VERSION_MINOR(desc.apiVersion),
                    "; Vulkan 1.1 is required");
  const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
      desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceProperties"));
  if (!getProperties) return out.error("getInstanceProcAddr", "does not find vkGetPhysicalDeviceProperties");
  VkPhysicalDeviceProperties properties;
  getProperties(desc.physicalDevice, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_1)
    return out.fail(PELLUCID_ERROR_MISSING_FEATURE, "physicalDevice", properties.deviceName, " has Vulkan ",
                    VK_API_VERSION_MAJOR(properties.apiVersion), ".",
                    VK_API_VERSION_MINOR(properties.apiVersion), "; 1.1 is required");
  checkLimits(desc, properties, out);
}

// The name of the first function that the device does not have, or nullptr when the table is complete.
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

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidCreateContext(const PellucidContextDesc* desc, PellucidContext** context) {
  if (!context) return PELLUCID_ERROR_INVALID_ARGUMENT;
  *context = nullptr;
  if (!desc) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Findings out(desc->message, desc->messageUser);
  checkDesc(*desc, out);
  if (!out.ok()) return out.result();

  auto* c = new (std::nothrow) PellucidContext;
  if (!c) return PELLUCID_ERROR_OUT_OF_MEMORY;
  c->device = desc->device;
  if (desc->options.allocator) {
    c->allocator = *desc->options.allocator;
    c->hasAllocator = true;
  }
  c->desc = *desc;
  const auto getDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
      desc->getInstanceProcAddr(desc->instance, "vkGetDeviceProcAddr"));
  const char* missing =
      getDeviceProcAddr ? loadVkTable(getDeviceProcAddr, desc->device, &c->vk) : "vkGetDeviceProcAddr";
  if (missing) {
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "device", "has no ", missing);
    delete c;
    return out.result();
  }
  if (!desc->options.descriptorPools && !c->vk.pushDescriptorSet) {
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "device",
             "has no vkCmdPushDescriptorSetKHR; is VK_KHR_push_descriptor enabled? Devices without it need "
             "descriptorPools = 1");
    delete c;
    return out.result();
  }
  PellucidResult result = createLayouts(*c, out);
  if (result == PELLUCID_OK) result = createPipelines(*c, out);
  if (result != PELLUCID_OK) {
    pellucidDestroyContext(c);
    return result;
  }
  *context = c;
  return PELLUCID_OK;
}

extern "C" PellucidResult pellucidCreateDescriptorPool(const PellucidContext* c, VkDescriptorPool* pool) {
  if (!c || !pool) return PELLUCID_ERROR_INVALID_ARGUMENT;
  *pool = VK_NULL_HANDLE;
  Findings out(c->desc.message, c->desc.messageUser);
  VkDescriptorPoolSize sizes[] = {{kUniforms, 0}, {kStorage, 0}, {kSampled, 0}, {kStored, 0}};
  for (VkDescriptorPoolSize& size : sizes)
    size.descriptorCount = PELLUCID_MAX_DISPATCHES * mostBindings(size.type);
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = PELLUCID_MAX_DISPATCHES;
  info.poolSizeCount = static_cast<uint32_t>(std::size(sizes));
  info.pPoolSizes = sizes;
  const VkResult result = c->vk.vkCreateDescriptorPool(c->device, &info, c->callbacks(), pool);
  return result == VK_SUCCESS ? PELLUCID_OK : vulkanError(out, "vkCreateDescriptorPool", result);
}

extern "C" void pellucidDestroyContext(PellucidContext* c) {
  if (!c) return;
  for (VkPipeline pipeline : c->pipelines) c->vk.vkDestroyPipeline(c->device, pipeline, c->callbacks());
  for (VkPipelineLayout layout : c->pipelineLayouts)
    c->vk.vkDestroyPipelineLayout(c->device, layout, c->callbacks());
  for (VkDescriptorSetLayout layout : c->setLayouts)
    c->vk.vkDestroyDescriptorSetLayout(c->device, layout, c->callbacks());
  delete c;
}

extern "C" const char* pellucidResultName(PellucidResult result) {
#define PELLUCID_CASE(name) \
  case name:                \
    return #name;
  switch (result) {
    PELLUCID_CASE(PELLUCID_OK)
    PELLUCID_CASE(PELLUCID_ERROR_INVALID_ARGUMENT)
    PELLUCID_CASE(PELLUCID_ERROR_VERSION)
    PELLUCID_CASE(PELLUCID_ERROR_MISSING_FEATURE)
    PELLUCID_CASE(PELLUCID_ERROR_OUT_OF_MEMORY)
    PELLUCID_CASE(PELLUCID_ERROR_VULKAN)
    PELLUCID_CASE(PELLUCID_ERROR_CAPACITY)
    PELLUCID_CASE(PELLUCID_ERROR_BUFFER_TOO_SMALL)
    default:
      return "unknown result";
  }
#undef PELLUCID_CASE
}
