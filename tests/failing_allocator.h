// Vulkan's allocation callbacks, one call of which fails.
#pragma once

#include <cstdlib>
#include <cstring>
#include <map>

#include <vulkan/vulkan_core.h>

namespace pellucid::test {

class FailingAllocator {
public:
  int failing = -1;  // the number of the call that fails, from 0; -1: none does
  int calls = 0;

  size_t live() const { return sizes_.size(); }  // allocations that are not freed

  // Of one thread's use. The allocator must live as long as what they allocate.
  VkAllocationCallbacks callbacks() {
    VkAllocationCallbacks c{};
    c.pUserData = this;
    c.pfnAllocation = [](void* user, size_t size, size_t alignment, VkSystemAllocationScope) {
      return static_cast<FailingAllocator*>(user)->allocate(size, alignment);
    };
    c.pfnReallocation = [](void* user, void* old, size_t size, size_t alignment, VkSystemAllocationScope) {
      return static_cast<FailingAllocator*>(user)->reallocate(old, size, alignment);
    };
    c.pfnFree = [](void* user, void* memory) { static_cast<FailingAllocator*>(user)->release(memory); };
    return c;
  }

private:
  void* allocate(size_t size, size_t alignment) {
    if (calls++ == failing) return nullptr;
    void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    sizes_[memory] = size;
    return memory;
  }
  void* reallocate(void* old, size_t size, size_t alignment) {
    if (size == 0) {
      release(old);
      return nullptr;
    }
    void* memory = allocate(size, alignment);
    if (memory && old) {
      std::memcpy(memory, old, size < sizes_.at(old) ? size : sizes_.at(old));
      release(old);
    }
    return memory;
  }
  void release(void* memory) {
    if (!memory) return;
    sizes_.erase(memory);
    std::free(memory);
  }

  std::map<void*, size_t> sizes_;
};

}  // namespace pellucid::test
