#include "common/pixel_pass.h"

#include <map>
#include <string>
#include <utility>

#include "common/barrier.h"

namespace pellucid::harness {

namespace {

std::vector<VkDescriptorSetLayoutBinding> layoutBindings(const std::vector<PixelPass::Binding>& bindings) {
  std::vector<VkDescriptorSetLayoutBinding> result;
  for (const PixelPass::Binding& binding : bindings)
    result.push_back({static_cast<std::uint32_t>(result.size()), binding.type, binding.count,
                      VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  return result;
}

constexpr int kGroup = 8;  // a side, pixels
std::uint32_t groups(int pixels) { return static_cast<std::uint32_t>((pixels + kGroup - 1) / kGroup); }

}  // namespace

struct PixelPass::Shared {
  Owned<VkSampler, vkDestroySampler> sampler;
  PushLayout layout;
  Pipeline pipeline;

  Shared(Device& device, const Spirv& code, const std::vector<Binding>& bindings, std::uint32_t pushSize,
         const VkSpecializationInfo& constants)
      : sampler(device),
        layout(device, layoutBindings(bindings), {VK_SHADER_STAGE_COMPUTE_BIT, 0, pushSize}),
        pipeline(device) {
    const VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    check(vkCreateSampler(device.handle(), &info, nullptr, sampler.receive()), "vkCreateSampler");
    createPipeline(device, layout, code, constants, pipeline);
  }
};

// By code and the bytes of its constants.
struct PixelPass::AllShared
    : std::map<std::pair<const std::uint32_t*, std::string>, std::shared_ptr<const Shared>> {
  explicit AllShared(Device&) {}
};

PixelPass::PixelPass(Device& device, const Spirv& code, const std::vector<Binding>& bindings,
                     std::uint32_t pushSize, const VkSpecializationInfo& constants)
    : pushSize_(pushSize) {
  const std::string bytes(static_cast<const char*>(constants.pData), constants.dataSize);
  std::shared_ptr<const Shared>& shared = device.kept<AllShared>()[{code.words, bytes}];
  if (!shared) shared = std::make_shared<const Shared>(device, code, bindings, pushSize, constants);
  shared_ = shared;
}

VkSampler PixelPass::sampler() const { return shared_->sampler; }

void PixelPass::record(VkCommandBuffer commands, std::span<const VkWriteDescriptorSet> writes, int width,
                       int height, const void* push) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shared_->pipeline);
  shared_->layout.push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, writes);
  if (pushSize_ > 0)
    vkCmdPushConstants(commands, shared_->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, pushSize_, push);
  vkCmdDispatch(commands, groups(width), groups(height), 1);
  barrier(commands, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
          {VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT});
}

}  // namespace pellucid::harness
