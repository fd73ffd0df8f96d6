// A Vulkan device that computes nothing: functions that make handles and check what is recorded. Contexts of
// it cost microseconds and need no driver, so that tests can make thousands.
#pragma once

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::test {

// A barrier, or a dispatch.
struct NullCommand {
  bool barrier = false;
  bool indirect = false;  // the barrier is one for commands of dispatches, or the dispatch has such
  VkImageView image = VK_NULL_HANDLE;  // the first that the dispatch binds
  VkPipeline pipeline = VK_NULL_HANDLE;
  bool operator==(const NullCommand&) const = default;
};

// One command buffer: counts, its commands in their order, and the first rule of Vulkan or of pellucid.h that
// was broken.
struct NullCommands {
  uint32_t dispatches = 0, barriers = 0;
  std::vector<NullCommand> commands;
  std::string problem;
  VkDeviceSize sliceOffset = 0, sliceSize = 0;  // set by the test: what buffers may be bound and read

  VkCommandBuffer handle() { return reinterpret_cast<VkCommandBuffer>(this); }

  void require(bool holds, const char* rule) {
    if (!holds && problem.empty()) problem = rule;
  }
  bool isInSlice(VkDeviceSize offset, VkDeviceSize size) const {
    return offset >= sliceOffset && size <= sliceSize && offset - sliceOffset <= sliceSize - size;
  }

  std::set<VkDescriptorSet> sets;  // that were bound
  bool hasPipeline = false, hasBindings = false, hasConstants = false;
  VkPipeline pipeline = VK_NULL_HANDLE;  // that is bound
  VkImageView firstImage = VK_NULL_HANDLE;
};

class NullDevice {
public:
  NullDevice() = default;
  NullDevice(const NullDevice&) = delete;
  ~NullDevice() {
    if (live != 0) std::abort();  // a context outlives its device
  }

  std::atomic<int> live = 0;      // Vulkan objects
  const char* missing = nullptr;  // a device function that does not exist
  VkPhysicalDeviceLimits limits = leastLimits();
  bool writesWithoutFormat = true;            // shaderStorageImageWriteWithoutFormat
  uint32_t mostPushed = 32;                   // the least that Vulkan lets a device have
  VkFormat notStorage = VK_FORMAT_UNDEFINED;  // a format without storage images

  PellucidContextDesc desc() {
    PellucidContextDesc d;
    pellucidInitContextDesc(&d);
    d.instance = reinterpret_cast<VkInstance>(this);
    d.physicalDevice = reinterpret_cast<VkPhysicalDevice>(this);
    d.device = reinterpret_cast<VkDevice>(this);
    d.getInstanceProcAddr = getInstanceProcAddr;
    return d;
  }

  // A function of the device by its name, or nullptr.
  PFN_vkVoidFunction function(const char* name) {
    return getDeviceProcAddr(reinterpret_cast<VkDevice>(this), name);
  }

private:
  using Function = PFN_vkVoidFunction;
  template <class F>
  static Function function(F* f) {
    return reinterpret_cast<Function>(f);
  }

  struct NamedFunction {
    const char* name;
    Function function;
  };
  template <size_t N>
  static Function find(const NamedFunction (&table)[N], const char* name) {
    for (const NamedFunction& entry : table)
      if (std::strcmp(name, entry.name) == 0) return entry.function;
    return nullptr;
  }

  static NullDevice& of(VkDevice device) { return *reinterpret_cast<NullDevice*>(device); }
  static NullCommands& of(VkCommandBuffer buffer) { return *reinterpret_cast<NullCommands*>(buffer); }

  static constexpr size_t kObjectBytes = 32, kAlignment = 16;

  template <class Handle>
  static VkResult create(VkDevice device, const VkAllocationCallbacks* a, Handle* handle) {
    void* object =
        a ? a->pfnAllocation(a->pUserData, kObjectBytes, kAlignment, VK_SYSTEM_ALLOCATION_SCOPE_OBJECT)
          : std::malloc(kObjectBytes);
    *handle = reinterpret_cast<Handle>(object);
    if (!object) return VK_ERROR_OUT_OF_HOST_MEMORY;
    ++of(device).live;
    return VK_SUCCESS;
  }
  template <class Handle>
  static void VKAPI_PTR destroy(VkDevice device, Handle handle, const VkAllocationCallbacks* a) {
    if (!handle) return;
    --of(device).live;
    if (a)
      a->pfnFree(a->pUserData, handle);
    else
      std::free(handle);
  }
  template <class Handle, class Info>
  static VkResult VKAPI_PTR createFrom(VkDevice device, const Info*, const VkAllocationCallbacks* a,
                                       Handle* handle) {
    return create(device, a, handle);
  }
  static VkResult VKAPI_PTR createPipelines(VkDevice device, VkPipelineCache, uint32_t count,
                                            const VkComputePipelineCreateInfo*,
                                            const VkAllocationCallbacks* a, VkPipeline* pipelines) {
    // A driver takes memory for the call, too.
    void* forCall = nullptr;
    if (a) {
      forCall = a->pfnAllocation(a->pUserData, kObjectBytes, kAlignment, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND);
      if (!forCall) return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count; ++i)
      if (create(device, a, &pipelines[i]) != VK_SUCCESS) result = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (a) a->pfnFree(a->pUserData, forCall);
    return result;
  }

  static void VKAPI_PTR bindPipeline(VkCommandBuffer buffer, VkPipelineBindPoint point, VkPipeline pipeline) {
    NullCommands& c = of(buffer);
    c.require(point == VK_PIPELINE_BIND_POINT_COMPUTE && pipeline, "vkCmdBindPipeline without a pipeline");
    c.hasPipeline = true;
    c.pipeline = pipeline;
  }
  static void VKAPI_PTR pushConstants(VkCommandBuffer buffer, VkPipelineLayout layout,
                                      VkShaderStageFlags stages, uint32_t offset, uint32_t size,
                                      const void* values) {
    NullCommands& c = of(buffer);
    c.require(stages == VK_SHADER_STAGE_COMPUTE_BIT, "vkCmdPushConstants of other stages");
    c.require(layout && values && offset == 0 && size == PELLUCID_PUSH_CONSTANT_BYTES,
              "vkCmdPushConstants of another range than the layout's");
    c.hasConstants = true;
  }
  static void VKAPI_PTR pushDescriptorSet(VkCommandBuffer buffer, VkPipelineBindPoint point, VkPipelineLayout,
                                          uint32_t set, uint32_t count, const VkWriteDescriptorSet* writes) {
    NullCommands& c = of(buffer);
    c.require(point == VK_PIPELINE_BIND_POINT_COMPUTE, "bindings of another bind point");
    c.require(set == 0, "another set than the first");
    takeBindings(c, count, writes);
  }
  static void takeBindings(NullCommands& c, uint32_t count, const VkWriteDescriptorSet* writes) {
    c.require(count > 0 && count <= PELLUCID_MAX_BINDINGS, "wrong number of bindings");
    c.firstImage = VK_NULL_HANDLE;
    for (uint32_t i = 0; i < count; ++i) {
      const VkWriteDescriptorSet& w = writes[i];
      for (uint32_t k = 0; k < i; ++k)
        c.require(writes[k].dstBinding != w.dstBinding, "a binding is written twice");
      if (w.pBufferInfo) {
        const VkDescriptorBufferInfo& b = *w.pBufferInfo;
        c.require(b.buffer && b.range > 0 && c.isInSlice(b.offset, b.range), "a buffer leaves the slice");
        // The largest alignment that a device may ask for, of storage and uniform buffers.
        c.require((b.offset - c.sliceOffset) % 256 == 0, "a buffer's offset is no multiple of 256");
      } else {
        c.require(w.pImageInfo && w.pImageInfo->imageView, "an image is bound without a view");
        if (w.pImageInfo && !c.firstImage) c.firstImage = w.pImageInfo->imageView;
      }
    }
    c.hasBindings = true;
  }
  // A set of a pool keeps what is written to it.
  struct NullSet {
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkDescriptorImageInfo> images;
  };
  struct NullPool {
    uint32_t most = 0;
    std::vector<std::unique_ptr<NullSet>> sets;
  };
  static NullPool& of(VkDescriptorPool pool) { return *reinterpret_cast<NullPool*>(pool); }
  static NullSet& of(VkDescriptorSet set) { return *reinterpret_cast<NullSet*>(set); }
  static VkResult VKAPI_PTR createPool(VkDevice device, const VkDescriptorPoolCreateInfo* info,
                                       const VkAllocationCallbacks*, VkDescriptorPool* pool) {
    auto* made = new NullPool;
    made->most = info->maxSets;
    for (uint32_t i = 0; i < info->poolSizeCount; ++i)
      if (info->pPoolSizes[i].descriptorCount < info->maxSets) made->most = 0;  // no room for any set
    *pool = reinterpret_cast<VkDescriptorPool>(made);
    ++of(device).live;
    return VK_SUCCESS;
  }
  static void VKAPI_PTR destroyPool(VkDevice device, VkDescriptorPool pool, const VkAllocationCallbacks*) {
    delete &of(pool);
    --of(device).live;
  }
  static VkResult VKAPI_PTR resetPool(VkDevice, VkDescriptorPool pool, VkDescriptorPoolResetFlags) {
    of(pool).sets.clear();
    return VK_SUCCESS;
  }
  static VkResult VKAPI_PTR allocateSets(VkDevice, const VkDescriptorSetAllocateInfo* info,
                                         VkDescriptorSet* sets) {
    NullPool& pool = of(info->descriptorPool);
    for (uint32_t i = 0; i < info->descriptorSetCount; ++i) {
      if (pool.sets.size() == pool.most) return VK_ERROR_OUT_OF_POOL_MEMORY;
      pool.sets.push_back(std::make_unique<NullSet>());
      sets[i] = reinterpret_cast<VkDescriptorSet>(pool.sets.back().get());
    }
    return VK_SUCCESS;
  }
  static void VKAPI_PTR updateSets(VkDevice, uint32_t count, const VkWriteDescriptorSet* writes, uint32_t,
                                   const VkCopyDescriptorSet*) {
    NullSet& set = of(writes[0].dstSet);
    set.writes.assign(writes, writes + count);
    set.buffers.resize(count);
    set.images.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
      if (writes[i].pBufferInfo) set.writes[i].pBufferInfo = &(set.buffers[i] = *writes[i].pBufferInfo);
      if (writes[i].pImageInfo) set.writes[i].pImageInfo = &(set.images[i] = *writes[i].pImageInfo);
    }
  }
  static void VKAPI_PTR bindSets(VkCommandBuffer buffer, VkPipelineBindPoint, VkPipelineLayout,
                                 uint32_t first, uint32_t count, const VkDescriptorSet* sets, uint32_t,
                                 const uint32_t*) {
    NullCommands& c = of(buffer);
    c.require(first == 0 && count == 1, "another set than the first");
    c.require(c.sets.insert(sets[0]).second, "a set is bound for two dispatches");
    const NullSet& set = of(sets[0]);
    takeBindings(c, static_cast<uint32_t>(set.writes.size()), set.writes.data());
  }
  static void VKAPI_PTR barrier(VkCommandBuffer buffer, VkPipelineStageFlags, VkPipelineStageFlags after,
                                VkDependencyFlags, uint32_t, const VkMemoryBarrier*, uint32_t buffers,
                                const VkBufferMemoryBarrier*, uint32_t images, const VkImageMemoryBarrier*) {
    of(buffer).require(buffers == 0 && images == 0, "a barrier of the caller's images or buffers");
    ++of(buffer).barriers;
    of(buffer).commands.push_back({true, (after & VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT) != 0});
  }
  static void dispatchAny(NullCommands& c, bool indirect) {
    c.require(c.hasPipeline && c.hasBindings && c.hasConstants, "a dispatch without what it needs");
    c.hasPipeline = c.hasBindings = c.hasConstants = false;
    ++c.dispatches;
    c.commands.push_back({false, indirect, c.firstImage, c.pipeline});
  }
  static void VKAPI_PTR dispatch(VkCommandBuffer buffer, uint32_t x, uint32_t y, uint32_t z) {
    NullCommands& c = of(buffer);
    // The least maxComputeWorkGroupCount that Vulkan allows a device.
    for (const uint32_t groups : {x, y, z})
      c.require(groups >= 1 && groups <= 65535, "groups outside 1..65535");
    dispatchAny(c, false);
  }
  static void VKAPI_PTR dispatchIndirect(VkCommandBuffer buffer, VkBuffer commands, VkDeviceSize offset) {
    NullCommands& c = of(buffer);
    c.require(commands && offset % 4 == 0 && c.isInSlice(offset, sizeof(VkDispatchIndirectCommand)),
              "an indirect command outside the slice");
    dispatchAny(c, true);
  }

  // Those of the module's needs, as little as Vulkan allows but for the invocations of a group.
  static VkPhysicalDeviceLimits leastLimits() {
    VkPhysicalDeviceLimits l{};
    l.maxComputeWorkGroupInvocations = 256;
    l.maxComputeSharedMemorySize = 16384;
    l.maxPushConstantsSize = 128;
    l.maxUniformBufferRange = 16384;
    l.maxPerStageDescriptorUniformBuffers = 12;
    l.maxPerStageDescriptorStorageBuffers = l.maxPerStageDescriptorStorageImages = 4;
    l.maxPerStageDescriptorSampledImages = 16;
    l.maxPerStageResources = 128;
    return l;
  }
  static NullDevice& of(VkPhysicalDevice device) { return *reinterpret_cast<NullDevice*>(device); }
  static void VKAPI_PTR getProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
    *properties = {};
    properties->apiVersion = VK_API_VERSION_1_1;
    properties->limits = of(device).limits;
    std::strcpy(properties->deviceName, "null device");
  }
  static void VKAPI_PTR getProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    getProperties(device, &properties->properties);
    static_cast<VkPhysicalDevicePushDescriptorPropertiesKHR*>(properties->pNext)->maxPushDescriptors =
        of(device).mostPushed;
  }
  static void VKAPI_PTR getFeatures(VkPhysicalDevice device, VkPhysicalDeviceFeatures* features) {
    *features = {};
    features->shaderStorageImageWriteWithoutFormat = of(device).writesWithoutFormat;
  }
  static void VKAPI_PTR getFormat(VkPhysicalDevice device, VkFormat format, VkFormatProperties* properties) {
    *properties = {};
    if (format != of(device).notStorage)
      properties->optimalTilingFeatures = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  }

  static Function VKAPI_PTR getInstanceProcAddr(VkInstance, const char* name) {
    const NamedFunction table[] = {{"vkGetPhysicalDeviceProperties", function(getProperties)},
                                   {"vkGetPhysicalDeviceProperties2", function(getProperties2)},
                                   {"vkGetPhysicalDeviceFeatures", function(getFeatures)},
                                   {"vkGetPhysicalDeviceFormatProperties", function(getFormat)},
                                   {"vkGetDeviceProcAddr", function(getDeviceProcAddr)}};
    return find(table, name);
  }

  static Function VKAPI_PTR getDeviceProcAddr(VkDevice device, const char* name) {
    if (of(device).missing && std::strcmp(name, of(device).missing) == 0) return nullptr;
    const NamedFunction table[] = {
        {"vkCreateDescriptorSetLayout",
         function(createFrom<VkDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo>)},
        {"vkDestroyDescriptorSetLayout", function(destroy<VkDescriptorSetLayout>)},
        {"vkCreatePipelineLayout", function(createFrom<VkPipelineLayout, VkPipelineLayoutCreateInfo>)},
        {"vkDestroyPipelineLayout", function(destroy<VkPipelineLayout>)},
        {"vkCreateShaderModule", function(createFrom<VkShaderModule, VkShaderModuleCreateInfo>)},
        {"vkDestroyShaderModule", function(destroy<VkShaderModule>)},
        {"vkCreateComputePipelines", function(createPipelines)},
        {"vkDestroyPipeline", function(destroy<VkPipeline>)},
        {"vkCmdBindPipeline", function(bindPipeline)},
        {"vkCmdPushConstants", function(pushConstants)},
        {"vkCmdPushDescriptorSetKHR", function(pushDescriptorSet)},
        {"vkCreateDescriptorPool", function(createPool)},
        {"vkDestroyDescriptorPool", function(destroyPool)},
        {"vkResetDescriptorPool", function(resetPool)},
        {"vkAllocateDescriptorSets", function(allocateSets)},
        {"vkUpdateDescriptorSets", function(updateSets)},
        {"vkCmdBindDescriptorSets", function(bindSets)},
        {"vkCmdPipelineBarrier", function(barrier)},
        {"vkCmdDispatch", function(dispatch)},
        {"vkCmdDispatchIndirect", function(dispatchIndirect)}};
    return find(table, name);
  }
};

}  // namespace pellucid::test
