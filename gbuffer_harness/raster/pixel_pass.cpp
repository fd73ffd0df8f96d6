#include "raster/pixel_pass.h"

#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

std::vector<VkDescriptorSetLayoutBinding> layoutBindings(const std::vector<PixelPass::Binding>& bindings) {
  std::vector<VkDescriptorSetLayoutBinding> result;
  for (const PixelPass::Binding& binding : bindings)
    result.push_back({static_cast<std::uint32_t>(result.size()), binding.type, binding.count,
                      VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  return result;
}

std::uint32_t groups(int pixels, int size) { return static_cast<std::uint32_t>((pixels + size - 1) / size); }

}  // namespace

PixelPass::PixelPass(Device& device, const Spirv& code, const std::vector<Binding>& bindings,
                     std::uint32_t pushSize, const VkSpecializationInfo& constants)
    : pushSize_(pushSize),
      sampler_(device),
      layout_(device, layoutBindings(bindings), {VK_SHADER_STAGE_COMPUTE_BIT, 0, pushSize}),
      pipeline_(device) {
  const VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  check(vkCreateSampler(device.handle(), &sampler, nullptr, sampler_.receive()), "vkCreateSampler");
  createPipeline(device, layout_, code, constants, pipeline_);
}

void PixelPass::record(VkCommandBuffer commands, std::span<const VkWriteDescriptorSet> writes, int width,
                       int height, const void* push) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  layout_.push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, writes);
  if (pushSize_ > 0) vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, pushSize_, push);
  vkCmdDispatch(commands, groups(width, PELLUCID_GROUP_X), groups(height, PELLUCID_GROUP_Y), 1);
  barrier(commands, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
          {VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT});
}

}  // namespace pellucid::harness
