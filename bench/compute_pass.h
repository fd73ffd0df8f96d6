// A compute pipeline with push descriptors, for the passes that are not the module's.
#pragma once

#include <array>
#include <span>
#include <variant>
#include <vector>

#include "common/barrier.h"
#include "common/device.h"
#include "common/push_layout.h"
#include "pellucid/pellucid.h"

namespace pellucid::bench {

// What a binding holds.
using Resource = std::variant<PellucidImage, VkDescriptorBufferInfo>;

// How many pixels one workgroup does, and the constants 0.. that say so to the shader.
struct Tile {
  uint32_t width = 8, height = 8;
  std::vector<uint32_t> specialization = {};
};

class ComputePass {
public:
  // types[i] is binding i of set 0. Combined image samplers are linear and clamp to the edge. The shader may
  // have four words of push constants.
  ComputePass(harness::Device& device, std::span<const uint32_t> spirv,
              const std::vector<VkDescriptorType>& types, const Tile& tile = {});

  // Without a barrier.
  void record(VkCommandBuffer commandBuffer, int width, int height, const std::vector<Resource>& resources,
              const std::array<uint32_t, 4>& push = {}) const;

private:
  std::vector<VkDescriptorType> types_;
  Tile tile_;
  harness::Owned<VkSampler, vkDestroySampler> sampler_;
  harness::PushLayout layout_;
  harness::Pipeline pipeline_;
};

// What one dispatch writes, the next may read and overwrite.
inline void computeBarrier(VkCommandBuffer commandBuffer) {
  harness::barrier(commandBuffer, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
                   harness::kComputing);
}

}  // namespace pellucid::bench
