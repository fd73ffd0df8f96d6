#include "replay/deferred_pipelines.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "common/device.h"
#include "common/parallel.h"
#include "common/progress.h"

namespace pellucid::harness {
namespace {

using Words = std::vector<uint32_t>;

// Handles of ours are addresses: the module only passes them on.
template <class Object, class Handle>
Object* object(Handle handle) {
  return reinterpret_cast<Object*>(handle);
}
template <class Handle, class Object>
Handle handle(Object* object) {
  return reinterpret_cast<Handle>(object);
}

}  // namespace

struct DeferredPipelines::Pipeline {
  VkDevice device;
  VkPipelineLayout layout;
  Words words;
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint8_t> constants;
  VkPipeline compiled = VK_NULL_HANDLE;

  void compile() {
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = words.size() * sizeof words[0];
    moduleInfo.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &moduleInfo, nullptr, &module), "vkCreateShaderModule");
    const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                              constants.size(), constants.data()};
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    const VkResult result = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &compiled);
    vkDestroyShaderModule(device, module, nullptr);
    check(result, "vkCreateComputePipelines");
  }
};

// What the module calls in place of the driver's functions.
struct DeferredPipelines::Functions {
  static VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice, const VkShaderModuleCreateInfo* info,
                                                           const VkAllocationCallbacks*,
                                                           VkShaderModule* module) {
    *module = handle<VkShaderModule>(new Words(info->pCode, info->pCode + info->codeSize / sizeof(uint32_t)));
    return VK_SUCCESS;
  }

  static VKAPI_ATTR void VKAPI_CALL destroyShaderModule(VkDevice, VkShaderModule module,
                                                        const VkAllocationCallbacks*) {
    delete object<Words>(module);
  }

  // The module creates one pipeline a call.
  static VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache owner,
                                                               uint32_t,
                                                               const VkComputePipelineCreateInfo* info,
                                                               const VkAllocationCallbacks*,
                                                               VkPipeline* pipeline) {
    const VkSpecializationInfo& specialization = *info->stage.pSpecializationInfo;
    const auto* constants = static_cast<const uint8_t*>(specialization.pData);
    auto& all = object<DeferredPipelines>(owner)->pipelines_;
    all.push_back(std::make_unique<Pipeline>(
        Pipeline{device,
                 info->layout,
                 *object<Words>(info->stage.module),
                 {specialization.pMapEntries, specialization.pMapEntries + specialization.mapEntryCount},
                 {constants, constants + specialization.dataSize}}));
    *pipeline = handle<VkPipeline>(all.back().get());
    return VK_SUCCESS;
  }

  static VKAPI_ATTR void VKAPI_CALL destroyPipeline(VkDevice device, VkPipeline pipeline,
                                                    const VkAllocationCallbacks*) {
    if (pipeline) vkDestroyPipeline(device, object<Pipeline>(pipeline)->compiled, nullptr);
  }

  static VKAPI_ATTR void VKAPI_CALL bindPipeline(VkCommandBuffer commandBuffer, VkPipelineBindPoint point,
                                                 VkPipeline pipeline) {
    vkCmdBindPipeline(commandBuffer, point, object<Pipeline>(pipeline)->compiled);
  }

  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    const std::string_view wanted = name;
    const auto function = [](auto* f) { return reinterpret_cast<PFN_vkVoidFunction>(f); };
    if (wanted == "vkCreateShaderModule") return function(&createShaderModule);
    if (wanted == "vkDestroyShaderModule") return function(&destroyShaderModule);
    if (wanted == "vkCreateComputePipelines") return function(&createComputePipelines);
    if (wanted == "vkDestroyPipeline") return function(&destroyPipeline);
    if (wanted == "vkCmdBindPipeline") return function(&bindPipeline);
    return vkGetDeviceProcAddr(device, name);
  }

  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (std::string_view(name) == "vkGetDeviceProcAddr")
      return reinterpret_cast<PFN_vkVoidFunction>(&getDeviceProcAddr);
    return vkGetInstanceProcAddr(instance, name);
  }
};

DeferredPipelines::DeferredPipelines() = default;
DeferredPipelines::~DeferredPipelines() = default;

void DeferredPipelines::defer(PellucidContextDesc& desc) {
  desc.getInstanceProcAddr = &Functions::getInstanceProcAddr;
  desc.pipelineCache = handle<VkPipelineCache>(this);
  desc.parallelFor = nullptr;  // in their order
  desc.uses = 0;               // every one has its place
}

void DeferredPipelines::prepare(const PellucidPlan& plan) {
  const std::scoped_lock lock(mutex_);
  std::vector<Pipeline*> missing;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    Pipeline* pipeline = pipelines_.at(plan.dispatches[i].pipeline).get();
    if (!pipeline->compiled && std::find(missing.begin(), missing.end(), pipeline) == missing.end())
      missing.push_back(pipeline);
  }
  if (missing.empty()) return;
  const ProgressLine progress("compiling shaders");
  parallelRows(static_cast<int>(missing.size()), 0,
               [&](int i) { missing[static_cast<std::size_t>(i)]->compile(); });
}

}  // namespace pellucid::harness
