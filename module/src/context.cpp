// Pipelines, layouts, feature checks.
#include "context.h"

#include <new>

#include "defaults.h"
#include "shaders.h"
#include "shared/pellucid_shared.h"
#include "text.h"

namespace pellucid {
namespace {

template <class... Parts>
void say(const PellucidContextDesc& desc, const char* field, const Parts&... sentence) {
  if (!desc.message) return;
  char message[256];
  Text text(message, sizeof message);
  (text << ... << sentence);
  desc.message(desc.messageUser, PELLUCID_SEVERITY_ERROR, field, message);
}

PellucidResult vulkanError(const PellucidContextDesc& desc, const char* call, VkResult result) {
  say(desc, "device", call, " returned VkResult ", static_cast<int>(result));
  const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
  return memory ? PELLUCID_ERROR_OUT_OF_MEMORY : PELLUCID_ERROR_VULKAN;
}

VkDescriptorType descriptorType(uint32_t binding) {
  switch (binding) {
    case PELLUCID_BINDING_FRAME:
    case PELLUCID_BINDING_LIGHTS:
    case PELLUCID_BINDING_SHADOWS:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case PELLUCID_BINDING_MATERIALS:
    case PELLUCID_BINDING_KERNELS:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case PELLUCID_BINDING_DESTINATION:
    case PELLUCID_BINDING_LEVELS:
      return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    default:
      return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  }
}

PellucidResult checkDesc(const PellucidContextDesc& desc) {
  if (desc.headerVersion != PELLUCID_HEADER_VERSION) {
    say(desc, "headerVersion", "is ", desc.headerVersion, "; this library has ", PELLUCID_HEADER_VERSION);
    return PELLUCID_ERROR_VERSION;
  }
  if (!desc.instance || !desc.physicalDevice || !desc.device || !desc.getInstanceProcAddr) {
    say(desc,
        !desc.instance         ? "instance"
        : !desc.physicalDevice ? "physicalDevice"
        : !desc.device         ? "device"
                               : "getInstanceProcAddr",
        "is NULL");
    return PELLUCID_ERROR_INVALID_ARGUMENT;
  }
  if (desc.apiVersion < VK_API_VERSION_1_1) {
    say(desc, "apiVersion", "is ", VK_API_VERSION_MAJOR(desc.apiVersion), ".",
        VK_API_VERSION_MINOR(desc.apiVersion), "; Vulkan 1.1 is required");
    return PELLUCID_ERROR_MISSING_FEATURE;
  }
  const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
      desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceProperties"));
  if (!getProperties) {
    say(desc, "getInstanceProcAddr", "does not find vkGetPhysicalDeviceProperties");
    return PELLUCID_ERROR_INVALID_ARGUMENT;
  }
  VkPhysicalDeviceProperties properties;
  getProperties(desc.physicalDevice, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_1) {
    say(desc, "physicalDevice", properties.deviceName, " has Vulkan ",
        VK_API_VERSION_MAJOR(properties.apiVersion), ".", VK_API_VERSION_MINOR(properties.apiVersion),
        "; 1.1 is required");
    return PELLUCID_ERROR_MISSING_FEATURE;
  }
  return PELLUCID_OK;
}

PellucidResult createLayouts(const PellucidContextDesc& desc, PellucidContext& c) {
  VkDescriptorSetLayoutBinding bindings[PELLUCID_BINDING_COUNT];
  for (uint32_t i = 0; i < PELLUCID_BINDING_COUNT; ++i)
    bindings[i] = {i, descriptorType(i), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = PELLUCID_BINDING_COUNT;
  set.pBindings = bindings;
  VkResult result = c.vk.vkCreateDescriptorSetLayout(c.device, &set, c.callbacks(), &c.setLayout);
  if (result != VK_SUCCESS) return vulkanError(desc, "vkCreateDescriptorSetLayout", result);

  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, PELLUCID_PUSH_CONSTANT_BYTES};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &c.setLayout;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &push;
  result = c.vk.vkCreatePipelineLayout(c.device, &layout, c.callbacks(), &c.pipelineLayout);
  return result == VK_SUCCESS ? PELLUCID_OK : vulkanError(desc, "vkCreatePipelineLayout", result);
}

PellucidResult createPipelines(const PellucidContextDesc& desc, PellucidContext& c) {
  for (uint32_t i = 0; i < PELLUCID_PIPELINE_COUNT; ++i) {
    const Shader shader = shaderOf(i);
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = shader.wordCount * sizeof(uint32_t);
    moduleInfo.pCode = shader.words;
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult result = c.vk.vkCreateShaderModule(c.device, &moduleInfo, c.callbacks(), &module);
    if (result != VK_SUCCESS) return vulkanError(desc, "vkCreateShaderModule", result);

    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = c.pipelineLayout;
    result =
        c.vk.vkCreateComputePipelines(c.device, desc.pipelineCache, 1, &info, c.callbacks(), &c.pipelines[i]);
    c.vk.vkDestroyShaderModule(c.device, module, c.callbacks());
    if (result != VK_SUCCESS) return vulkanError(desc, "vkCreateComputePipelines", result);
  }
  return PELLUCID_OK;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidCreateContext(const PellucidContextDesc* given, PellucidContext** context) {
  if (!context) return PELLUCID_ERROR_INVALID_ARGUMENT;
  *context = nullptr;
  if (!given) return PELLUCID_ERROR_INVALID_ARGUMENT;
  if (!canReadStruct(given, kLeastContextDesc)) {
    say(*given, "structSize", "is ", given->structSize, "; this library reads ", kLeastContextDesc, " to ",
        sizeof(PellucidContextDesc), " bytes, and more if they are 0 (call pellucidInitContextDesc)");
    return PELLUCID_ERROR_VERSION;
  }
  const PellucidContextDesc whole = readStruct(given, defaultContextDesc());
  const PellucidContextDesc* desc = &whole;
  PellucidResult result = checkDesc(*desc);
  if (result != PELLUCID_OK) return result;

  auto* c = new (std::nothrow) PellucidContext;
  if (!c) return PELLUCID_ERROR_OUT_OF_MEMORY;
  c->device = desc->device;
  if (desc->allocator) {
    c->allocator = *desc->allocator;
    c->hasAllocator = true;
  }
  c->message = desc->message;
  c->messageUser = desc->messageUser;
  const auto getDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
      desc->getInstanceProcAddr(desc->instance, "vkGetDeviceProcAddr"));
  const char* missing =
      getDeviceProcAddr ? loadVkTable(getDeviceProcAddr, desc->device, &c->vk) : "vkGetDeviceProcAddr";
  if (missing) {
    say(*desc, "device", "has no ", missing, "; is VK_KHR_push_descriptor enabled?");
    delete c;
    return PELLUCID_ERROR_MISSING_FEATURE;
  }
  result = createLayouts(*desc, *c);
  if (result == PELLUCID_OK) result = createPipelines(*desc, *c);
  if (result != PELLUCID_OK) {
    pellucidDestroyContext(c);
    return result;
  }
  *context = c;
  return PELLUCID_OK;
}

extern "C" void pellucidDestroyContext(PellucidContext* c) {
  if (!c) return;
  for (VkPipeline pipeline : c->pipelines) c->vk.vkDestroyPipeline(c->device, pipeline, c->callbacks());
  c->vk.vkDestroyPipelineLayout(c->device, c->pipelineLayout, c->callbacks());
  c->vk.vkDestroyDescriptorSetLayout(c->device, c->setLayout, c->callbacks());
  delete c;
}
