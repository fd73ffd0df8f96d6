#include "sample/submissions.h"

namespace pellucid::sample {

Submissions::Submissions(const Device& device)
    : device_(device), pool_(device), computePool_(device), slots_{Slot(device), Slot(device), Slot(device)} {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                               VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, device.queueFamily()};
  check(vkCreateCommandPool(device.handle(), &pool, nullptr, pool_.receive()), "vkCreateCommandPool");
  pool.queueFamilyIndex = device.computeFamily();
  check(vkCreateCommandPool(device.handle(), &pool, nullptr, computePool_.receive()), "vkCreateCommandPool");
  const auto allocate = [&](VkCommandPool from, VkCommandBuffer& commands) {
    const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, from,
                                           VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check(vkAllocateCommandBuffers(device.handle(), &info, &commands), "vkAllocateCommandBuffers");
  };
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  for (Slot& slot : slots_) {
    for (int i = 0; i < 3; ++i) allocate(i == 1 ? computePool_ : pool_, slot.commands[i]);
    check(vkCreateFence(device.handle(), &fence, nullptr, slot.done.receive()), "vkCreateFence");
    for (Semaphore& after : slot.after)
      check(vkCreateSemaphore(device.handle(), &semaphore, nullptr, after.receive()), "vkCreateSemaphore");
  }
}

VkCommandBuffer Submissions::start(std::uint32_t step, VkQueue queue, VkPipelineStageFlags stages) {
  step_ = step, queue_ = queue, stages_ = stages;
  const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                      VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(slot_->commands[step], &info), "vkBeginCommandBuffer");
  return slot_->commands[step];
}

VkCommandBuffer Submissions::begin(std::uint64_t frame) {
  slot_ = &slots_[frame % kFramesInFlight];
  const VkFence done = slot_->done;
  check(vkWaitForFences(device_.handle(), 1, &done, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.handle(), 1, &done), "vkResetFences");
  return start(0, device_.queue(), 0);
}

VkCommandBuffer Submissions::goOn(VkQueue queue, VkPipelineStageFlags stages) {
  submit(slot_->after[step_], VK_NULL_HANDLE);
  return start(step_ + 1, queue, stages);
}

void Submissions::end() { submit(VK_NULL_HANDLE, slot_->done); }

void Submissions::submit(VkSemaphore signal, VkFence done) const {
  check(vkEndCommandBuffer(slot_->commands[step_]), "vkEndCommandBuffer");
  const VkSemaphore wait = step_ > 0 ? VkSemaphore{slot_->after[step_ - 1]} : VK_NULL_HANDLE;
  const VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr,          wait ? 1u : 0u, &wait, &stages_, 1,
                          &slot_->commands[step_],       signal ? 1u : 0u, &signal};
  check(vkQueueSubmit(queue_, 1, &info, done), "vkQueueSubmit");
}

}  // namespace pellucid::sample
