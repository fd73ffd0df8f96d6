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
    allocate(pool_, slot.drawing);
    allocate(computePool_, slot.computing);
    allocate(pool_, slot.drawingAgain);
    check(vkCreateFence(device.handle(), &fence, nullptr, slot.done.receive()), "vkCreateFence");
    for (auto* order : {&slot.drawn, &slot.computed})
      check(vkCreateSemaphore(device.handle(), &semaphore, nullptr, order->receive()), "vkCreateSemaphore");
  }
}

VkCommandBuffer Submissions::start(VkCommandBuffer commands) {
  const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                      VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
  return commands_ = commands;
}

VkCommandBuffer Submissions::begin(std::uint64_t frame) {
  slot_ = &slots_[frame % kFramesInFlight];
  again_ = false;
  const VkFence done = slot_->done;
  check(vkWaitForFences(device_.handle(), 1, &done, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.handle(), 1, &done), "vkResetFences");
  return start(slot_->drawing);
}

VkCommandBuffer Submissions::beginComputing() {
  submit(device_.queue(), {.signal = slot_->drawn});
  return start(slot_->computing);
}

VkCommandBuffer Submissions::beginDrawingAgain() {
  submit(device_.computeQueue(), {slot_->drawn, PELLUCID_STAGES, slot_->computed});
  again_ = true;
  return start(slot_->drawingAgain);
}

void Submissions::end() {
  submit(device_.queue(), again_ ? Order{slot_->computed, kDrawing.stages} : Order{}, slot_->done);
}

void Submissions::submit(VkQueue queue, const Order& order, VkFence done) const {
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.waitSemaphoreCount = order.wait ? 1 : 0;
  info.pWaitSemaphores = &order.wait;
  info.pWaitDstStageMask = &order.stages;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  info.signalSemaphoreCount = order.signal ? 1 : 0;
  info.pSignalSemaphores = &order.signal;
  check(vkQueueSubmit(queue, 1, &info, done), "vkQueueSubmit");
}

}  // namespace pellucid::sample
