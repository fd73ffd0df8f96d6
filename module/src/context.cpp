// Pipelines, layouts, feature checks.
#include "context.h"

#include <algorithm>
#include <bitset>
#include <iterator>
#include <memory>
#include <new>

#include "defaults.h"
#include "device_limits.h"
#include "output_format.h"
#include "shared/pellucid_shared.h"
#include "text.h"

namespace pellucid {

PellucidResult vulkanError(Findings& out, const char* call, VkResult result) {
  const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
  out.fail(memory ? PELLUCID_ERROR_OUT_OF_MEMORY : PELLUCID_ERROR_VULKAN, "device", call,
           " returned VkResult ", static_cast<int>(result));
  return out.result();
}

namespace {

constexpr uint32_t kAllUses = PELLUCID_USE_TRANSLUCENCY | PELLUCID_USE_GATHER | PELLUCID_USE_DIFFUSION |
                              PELLUCID_USE_REUSE | PELLUCID_USE_DEBUG_VIEWS | PELLUCID_USE_THIN_WALLS |
                              PELLUCID_USE_AMBIENT | PELLUCID_USE_THESIS;

PellucidResult checkDesc(const PellucidContextDesc& desc, Findings& out) {
  if (desc.headerVersion != PELLUCID_HEADER_VERSION) {
    out.fail(PELLUCID_ERROR_VERSION, "headerVersion", "is ", desc.headerVersion, "; this library has ",
             PELLUCID_HEADER_VERSION);
    return out.result();
  }
  if (!desc.instance || !desc.physicalDevice || !desc.device || !desc.getInstanceProcAddr) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT,
             !desc.instance         ? "instance"
             : !desc.physicalDevice ? "physicalDevice"
             : !desc.device         ? "device"
                                    : "getInstanceProcAddr",
             "is NULL");
    return out.result();
  }
  if (desc.options.outputFormat != VK_FORMAT_UNDEFINED &&
      desc.options.outputFormat != VK_FORMAT_R16G16B16A16_SFLOAT &&
      desc.options.outputFormat != VK_FORMAT_R32G32B32A32_SFLOAT) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.outputFormat", "is VkFormat ",
             static_cast<int>(desc.options.outputFormat),
             "; R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT and UNDEFINED are possible");
    return out.result();
  }
  if (desc.options.shadowViewType != VK_IMAGE_VIEW_TYPE_2D &&
      desc.options.shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.shadowViewType", "is VkImageViewType ",
             static_cast<int>(desc.options.shadowViewType), "; 2D and 2D_ARRAY are possible");
    return out.result();
  }
  if (desc.options.normalEncoding > PELLUCID_NORMALS_OCTAHEDRAL_UNORM) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.normalEncoding", "is ", desc.options.normalEncoding,
             ", not a PellucidNormalEncoding");
    return out.result();
  }
  if (desc.options.deferPipelines > 1) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.deferPipelines", "is ", desc.options.deferPipelines,
             ", not 0 or 1");
    return out.result();
  }
  if (desc.options.lightTables > 1) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.lightTables", "is ", desc.options.lightTables,
             ", not 0 or 1");
    return out.result();
  }
  if (desc.options.descriptorPools > 1) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.descriptorPools", "is ", desc.options.descriptorPools,
             ", not 0 or 1");
    return out.result();
  }
  if (desc.options.uses & ~kAllUses) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "options.uses", "has unknown bits ",
             desc.options.uses & ~kAllUses);
    return out.result();
  }
  if (desc.apiVersion < VK_API_VERSION_1_1) {
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "apiVersion", "is ", VK_API_VERSION_MAJOR(desc.apiVersion), ".",
             VK_API_VERSION_MINOR(desc.apiVersion), "; Vulkan 1.1 is required");
    return out.result();
  }
  const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
      desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceProperties"));
  if (!getProperties) {
    out.fail(PELLUCID_ERROR_INVALID_ARGUMENT, "getInstanceProcAddr",
             "does not find vkGetPhysicalDeviceProperties");
    return out.result();
  }
  VkPhysicalDeviceProperties properties;
  getProperties(desc.physicalDevice, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_1) {
    out.fail(PELLUCID_ERROR_MISSING_FEATURE, "physicalDevice", properties.deviceName, " has Vulkan ",
             VK_API_VERSION_MAJOR(properties.apiVersion), ".", VK_API_VERSION_MINOR(properties.apiVersion),
             "; 1.1 is required");
    return out.result();
  }
  checkLimits(desc, properties, out);
  return out.result();
}

// The set and the layout of a pass.
VkResult createLayout(PellucidContext& c, uint32_t index, const char** call) {
  VkDescriptorSetLayoutBinding bindings[PELLUCID_BINDING_COUNT];
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (!c.desc.options.descriptorPools) set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  forEach(allPasses()[index]->bindings(), [&](const Binding& b) {
    bindings[set.bindingCount++] = {b.number, b.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  });
  set.pBindings = bindings;
  *call = "vkCreateDescriptorSetLayout";
  const VkResult result =
      c.vk.vkCreateDescriptorSetLayout(c.device, &set, c.callbacks(), &c.setLayouts[index]);
  if (result != VK_SUCCESS) return result;

  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, PELLUCID_PUSH_CONSTANT_BYTES};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &c.setLayouts[index];
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &push;
  *call = "vkCreatePipelineLayout";
  return c.vk.vkCreatePipelineLayout(c.device, &layout, c.callbacks(), &c.pipelineLayouts[index]);
}

PellucidResult createLayouts(PellucidContext& c, Findings& out) {
  const char* call = nullptr;
  for (uint32_t i = 0; i < allPasses().size(); ++i)
    if (const VkResult result = createLayout(c, i, &call); result != VK_SUCCESS)
      return vulkanError(out, call, result);
  return PELLUCID_OK;
}

// One pipeline for each thread that the caller lends.
struct PipelineJobs {
  PellucidContext& context;
  std::array<uint32_t, kMostPasses> pipelines{};  // to make
  std::array<VkResult, kMostPasses> results{};
};

VkResult createPipeline(const PellucidContext& c, uint32_t index, VkPipeline* pipeline) {
  const PellucidContextDesc& desc = c.desc;
  const Pass& pass = *allPasses()[index];
  std::span<const uint32_t> words = pass.wordsFor(desc.options.shadowViewType);
  std::unique_ptr<uint32_t[]> patched;
  if (desc.options.outputFormat != VK_FORMAT_UNDEFINED) {
    patched.reset(new (std::nothrow) uint32_t[words.size()]);
    if (!patched) return VK_ERROR_OUT_OF_HOST_MEMORY;
    std::copy(words.begin(), words.end(), patched.get());
    fixOutputFormat(patched.get(), words.size(), desc.options.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT);
    words = {patched.get(), words.size()};
  }
  VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  moduleInfo.codeSize = words.size_bytes();
  moduleInfo.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  VkResult result = c.vk.vkCreateShaderModule(c.device, &moduleInfo, c.callbacks(), &module);
  if (result != VK_SUCCESS) return result;

  constexpr size_t kMostConstants = 5;
  std::array<PellucidSpecialization, kMostConstants> constants;
  PellucidSpecialization* end = std::copy(pass.constants.begin(), pass.constants.end(), constants.begin());
  *end++ = {PELLUCID_SPECIALIZATION_NORMALS, desc.options.normalEncoding};
  *end++ = {PELLUCID_SPECIALIZATION_LIGHT_TABLES, desc.options.lightTables};
  *end++ = {PELLUCID_SPECIALIZATION_USES, desc.options.uses != 0 ? desc.options.uses : UINT32_MAX};
  const auto count = static_cast<uint32_t>(end - constants.data());
  std::array<VkSpecializationMapEntry, kMostConstants> entries;
  for (uint32_t i = 0; i < count; ++i)
    entries[i] = {constants[i].id,
                  static_cast<uint32_t>(i * sizeof constants[0] + offsetof(PellucidSpecialization, value)),
                  sizeof(uint32_t)};
  const VkSpecializationInfo specialization{count, entries.data(), count * sizeof constants[0],
                                            constants.data()};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = c.pipelineLayouts[index];
  result =
      c.vk.vkCreateComputePipelines(c.device, desc.options.pipelineCache, 1, &info, c.callbacks(), pipeline);
  c.vk.vkDestroyShaderModule(c.device, module, c.callbacks());
  return result;
}

// Makes the pipelines among `wanted`, bits by index, that are of the context's uses and not there.
PellucidResult createPipelines(PellucidContext& c, std::bitset<kMostPasses> wanted, Findings& out) {
  const PellucidContextDesc& desc = c.desc;
  PipelineJobs jobs{c};
  uint32_t count = 0;
  for (uint32_t i = 0; i < allPasses().size(); ++i)
    if (wanted[i] && !c.pipelines[i] &&
        (desc.options.uses == 0 || (allPasses()[i]->uses & ~desc.options.uses) == 0))
      jobs.pipelines[count++] = i;
  if (count == 0) return PELLUCID_OK;
  const auto job = [](void* data, uint32_t i) {
    auto& all = *static_cast<PipelineJobs*>(data);
    const uint32_t pipeline = all.pipelines[i];
    all.results[i] = createPipeline(all.context, pipeline, &all.context.pipelines[pipeline]);
  };
  if (desc.options.parallelFor)
    desc.options.parallelFor(desc.options.parallelUser, count, job, &jobs);
  else
    for (uint32_t i = 0; i < count; ++i) job(&jobs, i);
  for (uint32_t i = 0; i < count; ++i)
    if (jobs.results[i] != VK_SUCCESS) {
      char call[64];
      Text(call, sizeof call) << "creating pipeline " << allPasses()[jobs.pipelines[i]]->pipeline;
      return vulkanError(out, call, jobs.results[i]);
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
    // A struct that is too short has no callback to read.
    constexpr size_t kHasMessage = offsetof(PellucidContextDesc, messageUser) + sizeof given->messageUser;
    const bool tells = given->structSize >= kHasMessage;
    Findings out(tells ? given->message : nullptr, tells ? given->messageUser : nullptr);
    out.fail(PELLUCID_ERROR_VERSION, "structSize", "is ", given->structSize, "; this library reads ",
             kLeastContextDesc, " to ", sizeof(PellucidContextDesc),
             " bytes, and more if they are 0 (call pellucidInitContextDesc)");
    return out.result();
  }
  const PellucidContextDesc whole = readStruct(given, defaultContextDesc());
  const PellucidContextDesc* desc = &whole;
  Findings out(desc->message, desc->messageUser);
  PellucidResult result = checkDesc(*desc, out);
  if (result != PELLUCID_OK) return result;

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
  result = createLayouts(*c, out);
  if (result == PELLUCID_OK && !desc->options.deferPipelines)
    result = createPipelines(*c, std::bitset<kMostPasses>().set(), out);
  if (result != PELLUCID_OK) {
    pellucidDestroyContext(c);
    return result;
  }
  *context = c;
  return PELLUCID_OK;
}

extern "C" PellucidResult pellucidCreatePipelines(PellucidContext* c, const PellucidPlan* plan) {
  if (!c || !plan) return PELLUCID_ERROR_INVALID_ARGUMENT;
  std::bitset<kMostPasses> wanted;
  for (uint32_t i = 0; i < plan->dispatchCount; ++i)
    if (plan->dispatches[i].pipeline < allPasses().size()) wanted.set(plan->dispatches[i].pipeline);
  Findings out(c->desc.message, c->desc.messageUser);
  return createPipelines(*c, wanted, out);
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
