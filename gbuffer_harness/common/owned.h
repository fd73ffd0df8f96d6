// Device objects that are destroyed with their owner.
#pragma once

#include "common/device.h"

namespace pellucid::harness {

template <class Handle, void (*destroy)(VkDevice, Handle, const VkAllocationCallbacks*)>
class Owned {
public:
  explicit Owned(const Device& device) : device_(device.handle()) {}
  ~Owned() { destroy(device_, handle_, nullptr); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;

  Handle* receive() { return &handle_; }  // for vkCreate*
  operator Handle() const { return handle_; }

private:
  VkDevice device_;
  Handle handle_ = VK_NULL_HANDLE;
};

}  // namespace pellucid::harness
