// Commands of the frames in flight, and the order in which the device's queues run them.
#pragma once

#include "common/owned.h"
#include "sample/frame.h"

namespace pellucid::sample {

class Submissions {
public:
  explicit Submissions(const Device& device);

  // The frame's commands, once the frame kFramesInFlight before has finished.
  VkCommandBuffer begin(std::uint64_t frame);
  // Submits these. Later commands run after them, on the device's computeQueue().
  VkCommandBuffer beginComputing();
  // Submits these. Later commands, and drawing of later frames, run after them, on the device's queue().
  VkCommandBuffer beginDrawingAgain();
  void end();  // submits the last ones

private:
  struct Slot {
    explicit Slot(const Device& device) : done(device), drawn(device), computed(device) {}
    VkCommandBuffer drawing = VK_NULL_HANDLE, computing = VK_NULL_HANDLE, drawingAgain = VK_NULL_HANDLE;
    Owned<VkFence, vkDestroyFence> done;
    Owned<VkSemaphore, vkDestroySemaphore> drawn, computed;
  };
  // Semaphores of a submission: the one that `stages` wait for, and the one that it signals.
  struct Order {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkPipelineStageFlags stages = 0;
    VkSemaphore signal = VK_NULL_HANDLE;
  };

  VkCommandBuffer start(VkCommandBuffer commands);
  void submit(VkQueue queue, const Order& order, VkFence done = VK_NULL_HANDLE) const;

  const Device& device_;
  Owned<VkCommandPool, vkDestroyCommandPool> pool_, computePool_;
  Slot slots_[kFramesInFlight];
  Slot* slot_ = nullptr;  // the frame's
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool again_ = false;
};

}  // namespace pellucid::sample
