// Pipelines of passes as contexts have them, and as the API describes them.
#include <algorithm>
#include <memory>
#include <new>

#include "context.h"
#include "images.h"

namespace pellucid {
namespace {

// SPIR-V 1.3, sections 3.11, 3.31 and 3.32.
constexpr uint32_t kHeaderWords = 5, kOpTypeImage = 25, kOpCapability = 17;
constexpr uint32_t kCapabilityShader = 1, kCapabilityWriteWithoutFormat = 56;
constexpr uint32_t kUnknown = 0, kRgba32f = 1, kRgba16f = 2, kStorageImage = 2;

// Gives the storage image that has no format one of 16 or 32 bits a channel, in place.
void fixOutputFormat(uint32_t* words, std::size_t wordCount, bool wide) {
  for (std::size_t at = kHeaderWords; at < wordCount;) {
    const uint32_t opcode = words[at] & 0xFFFF, count = words[at] >> 16;
    if (count == 0 || count > wordCount - at) return;
    uint32_t* operands = words + at + 1;
    // A capability may be declared twice.
    if (opcode == kOpCapability && operands[0] == kCapabilityWriteWithoutFormat)
      operands[0] = kCapabilityShader;
    // result, sampled type, dim, depth, arrayed, multisampled, sampled, format
    if (opcode == kOpTypeImage && operands[6] == kStorageImage && operands[7] == kUnknown)
      operands[7] = wide ? kRgba32f : kRgba16f;
    at += count;
  }
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

VkResult createPipeline(const PellucidContext& c, uint32_t index, VkPipeline* pipeline) {
  const PellucidContextDesc& desc = c.desc;
  const Pass& pass = *allPasses()[index];
  const std::unique_ptr<uint32_t[]> words(new (std::nothrow) uint32_t[pass.wordsFor(desc.options.shadowViewType).size()]);
  if (!words) return VK_ERROR_OUT_OF_HOST_MEMORY;
  PellucidShader shader;
  pellucidGetShader(index, desc.options.shadowViewType, desc.options.outputFormat, words.get(), &shader);
  VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  moduleInfo.codeSize = shader.wordCount * sizeof(uint32_t);
  moduleInfo.pCode = shader.words;
  VkShaderModule module = VK_NULL_HANDLE;
  VkResult result = c.vk.vkCreateShaderModule(c.device, &moduleInfo, c.callbacks(), &module);
  if (result != VK_SUCCESS) return result;

  constexpr size_t kMostConstants = 4;
  std::array<PellucidSpecialization, kMostConstants> constants;
  PellucidSpecialization* end = std::copy(pass.constants.begin(), pass.constants.end(), constants.begin());
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

}  // namespace

PellucidResult createLayouts(PellucidContext& c, Findings& out) {
  const char* call = nullptr;
  for (uint32_t i = 0; i < allPasses().size(); ++i)
    if (const VkResult result = createLayout(c, i, &call); result != VK_SUCCESS)
      return vulkanError(out, call, result);
  return PELLUCID_OK;
}

PellucidResult createPipelines(PellucidContext& c, Findings& out) {
  const PellucidContextOptions& options = c.desc.options;
  struct Jobs {
    PellucidContext& context;
    std::array<VkResult, kMostPasses> results{};
  } jobs{c};
  const auto job = [](void* data, uint32_t i) {
    auto& [context, results] = *static_cast<Jobs*>(data);
    const uint32_t uses = context.desc.options.uses;
    if (uses == 0 || (allPasses()[i]->uses & ~uses) == 0) results[i] = createPipeline(context, i, &context.pipelines[i]);
  };
  const auto count = static_cast<uint32_t>(allPasses().size());
  if (options.parallelFor)
    options.parallelFor(options.parallelUser, count, job, &jobs);
  else
    for (uint32_t i = 0; i < count; ++i) job(&jobs, i);
  for (uint32_t i = 0; i < count; ++i)
    if (jobs.results[i] != VK_SUCCESS) {
      char call[64];
      Text(call, sizeof call) << "creating pipeline " << allPasses()[i]->pipeline;
      return vulkanError(out, call, jobs.results[i]);
    }
  return PELLUCID_OK;
}

// ---- The API's descriptions

uint32_t mostBindings(VkDescriptorType type) {
  uint32_t most = 0;
  for (const Pass* pass : allPasses()) {
    uint32_t count = 0;
    forEach(pass->bindings(), [&](const Binding& b) { count += b.type == type; });
    most = std::max(most, count);
  }
  return most;
}

uint32_t mostBindings() {
  uint32_t most = 0;
  for (const Pass* pass : allPasses())
    most = std::max(most, static_cast<uint32_t>(std::popcount(pass->bindings())));
  return most;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" uint32_t pellucidGetPipelineCount(void) { return static_cast<uint32_t>(allPasses().size()); }

extern "C" uint32_t pellucidGetPipelineBindings(uint32_t pipeline, PellucidBinding* bindings) {
  if (pipeline >= allPasses().size() || !bindings) return 0;
  const Pass& pass = *allPasses()[pipeline];
  uint32_t count = 0;
  forEach(pass.bindings(), [&](const Binding& b) { bindings[count++] = bindingOf(pass, b); });
  return count;
}

extern "C" const char* pellucidPipelineName(uint32_t pipeline) {
  return pipeline < allPasses().size() ? allPasses()[pipeline]->pipeline : "unknown pipeline";
}

extern "C" const char* pellucidBindingName(uint32_t binding) {
  return binding < kBindings.size() ? kBindings[binding].name : "unknown binding";
}

extern "C" PellucidResult pellucidGetShader(uint32_t pipeline, VkImageViewType shadowViewType, VkFormat outputFormat,
                                            uint32_t* words, PellucidShader* shader) {
  const bool known = shadowViewType == VK_IMAGE_VIEW_TYPE_2D || shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  const bool any = outputFormat == VK_FORMAT_UNDEFINED, wide = outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT;
  if (pipeline >= allPasses().size() || !known || !shader ||
      (!any && !wide && outputFormat != VK_FORMAT_R16G16B16A16_SFLOAT))
    return PELLUCID_ERROR_INVALID_ARGUMENT;
  const Pass& pass = *allPasses()[pipeline];
  const std::span<const uint32_t> own = pass.wordsFor(shadowViewType);
  if (!any && words) {
    std::copy(own.begin(), own.end(), words);
    fixOutputFormat(words, own.size(), wide);
  }
  *shader = {any ? own.data() : words, own.size(), static_cast<uint32_t>(pass.constants.size()), pass.constants.data(), pass.uses};
  return PELLUCID_OK;
}

extern "C" const char* pellucidResourceName(uint32_t resource) {
  for (const ImageField& image : kImageFields)
    if (image.resource == resource) return image.name;
  static constexpr const char* kTransients[] = {"transient0", "transient1", "transient2", "transient3",
                                                "transient4", "transient5", "transient6", "transient7"};
  static_assert(std::size(kTransients) == PELLUCID_MAX_TRANSIENTS);
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  if (transient < PELLUCID_MAX_TRANSIENTS) return kTransients[transient];
  if (resource == PELLUCID_RESOURCE_CONSTANTS) return "constants";
  if (resource == PELLUCID_RESOURCE_HISTORY) return "history";
  return resource >= PELLUCID_RESOURCE_SHADOW0 ? "shadowImage" : "unknown resource";
}
