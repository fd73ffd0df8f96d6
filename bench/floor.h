// The bandwidth floor: one pass over both depths, the irradiance and the output.
#pragma once

#include "common/gpu_image.h"

namespace pellucid::bench {

class FloorPass {
public:
  FloorPass(harness::Device& device, int width, int height);
  ~FloorPass();
  FloorPass(const FloorPass&) = delete;
  FloorPass& operator=(const FloorPass&) = delete;

  void record(VkCommandBuffer commandBuffer) const;
  // True when the pass wrote what its inputs say: a floor that skips work would be no floor.
  bool isRight() const;

private:
  harness::Device& device_;
  int width_, height_;
  harness::GpuImage front_, back_, irradiance_, result_;
  VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  PFN_vkCmdPushDescriptorSetKHR pushDescriptors_ = nullptr;
};

}  // namespace pellucid::bench
