// Compute passes that visit every pixel of an image.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/device.h"
#include "common/owned.h"
#include "common/push_layout.h"

namespace pellucid::harness {

class PixelPass {
public:
  struct Binding {
    VkDescriptorType type;
    std::uint32_t count = 1;
  };
  // bindings: 0, 1 and so on. pushSize: bytes of push constants. constants: of the code's specialization.
  // Passes of a device that have the same code and constants share a pipeline.
  PixelPass(Device& device, const Spirv& code, const std::vector<Binding>& bindings,
            std::uint32_t pushSize = 0, const VkSpecializationInfo& constants = {});

  VkSampler sampler() const;  // for texelFetch

  // In groups of 8 x 8. Everything after waits for what it writes.
  void record(VkCommandBuffer commands, std::span<const VkWriteDescriptorSet> writes, int width, int height,
              const void* push = nullptr) const;

private:
  struct Shared;
  struct AllShared;

  std::uint32_t pushSize_;
  std::shared_ptr<const Shared> shared_;
};

}  // namespace pellucid::harness
