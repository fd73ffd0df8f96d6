// Commands of the frames in flight, and the order in which the device's queues run them.
#pragma once

#include "common/device.h"
#include "common/owned.h"
#include "sample/frame.h"

namespace pellucid::sample {

using namespace pellucid::harness;

class Submissions {
public:
  explicit Submissions(const Device& device);

  // The frame's commands, once the frame kFramesInFlight before has finished.
  VkCommandBuffer begin(std::uint64_t frame);
  // Submits these. The stages of the frame's next commands, on this queue, wait for them: first
  // computeQueue(), then queue() again.
  VkCommandBuffer goOn(VkQueue queue, VkPipelineStageFlags stages);
  void end();  // submits the last ones

private:
  using Semaphore = Owned<VkSemaphore, vkDestroySemaphore>;
  struct Slot {
    explicit Slot(const Device& device) : done(device), after{Semaphore(device), Semaphore(device)} {}
    VkCommandBuffer commands[3] = {};  // draw, compute, draw
    Owned<VkFence, vkDestroyFence> done;
    Semaphore after[2];  // drawn, computed
  };

  VkCommandBuffer start(std::uint32_t step, VkQueue queue, VkPipelineStageFlags stages);
  void submit(VkSemaphore signal, VkFence done) const;

  const Device& device_;
  Owned<VkCommandPool, vkDestroyCommandPool> pool_, computePool_;
  Slot slots_[kFramesInFlight];
  Slot* slot_ = nullptr;    // the frame's
  std::uint32_t step_ = 0;  // of its commands
  VkQueue queue_ = VK_NULL_HANDLE;
  VkPipelineStageFlags stages_ = 0;  // that wait for the step before
};

}  // namespace pellucid::sample
