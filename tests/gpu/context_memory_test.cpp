// Creation of a context by a real driver, of whose host allocations some fail. tests/unit/context_test.cpp
// has every one, of the null device.
#include "failing_allocator.h"
#include "gpu_fixture.h"

namespace {

using namespace pellucid::test;

struct Attempt {
  PellucidResult result = PELLUCID_OK;
  int calls = 0;
  size_t live = 0;
  std::string message;
};

// Creates and destroys a context. `failing`: the allocation that fails.
Attempt attempt(Device& device, VkPipelineCache cache, int failing) {
  Attempt a;
  FailingAllocator allocator;
  allocator.failing = failing;
  const VkAllocationCallbacks callbacks = allocator.callbacks();
  PellucidContextDesc desc = contextDesc(device);
  desc.options.pipelineCache = cache;
  desc.options.uses = PELLUCID_USE_DIFFUSION;  // six pipelines: the others are created by the same code
  desc.options.allocator = &callbacks;
  desc.message = [](void* user, PellucidSeverity, const char* field, const char* message) {
    *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
  };
  desc.messageUser = &a.message;
  PellucidContext* context = nullptr;
  a.result = pellucidCreateContext(&desc, &context);
  EXPECT_EQ(context != nullptr, a.result == PELLUCID_OK);
  pellucidDestroyContext(context);
  a.calls = allocator.calls;
  a.live = allocator.live();
  return a;
}

TEST(ContextMemoryOfTheDriver, FailingAllocationsAreReportedAndNothingLeaks) {
  Device device;  // the validation layers allocate, too, and do not check
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  check(vkCreatePipelineCache(device.handle(), &info, nullptr, &cache), "vkCreatePipelineCache");
  const Attempt whole = attempt(device, cache, -1);
  EXPECT_EQ(whole.result, PELLUCID_OK) << whole.message;
  EXPECT_EQ(whole.live, 0u);
  ASSERT_GT(whole.calls, 2) << "the driver allocates nothing through the callbacks";
  // Few: what comes before the one that fails compiles.
  for (const int n : {0, 1, whole.calls / 4, whole.calls - 1}) {
    const Attempt a = attempt(device, cache, n);
    EXPECT_TRUE(a.result == PELLUCID_ERROR_OUT_OF_MEMORY || a.result == PELLUCID_ERROR_VULKAN)
        << n << ": " << pellucidResultName(a.result);
    EXPECT_NE(a.message.find("returned VkResult"), std::string::npos) << n << ": " << a.message;
    EXPECT_EQ(a.live, 0u) << n << ": " << a.message;
  }
  vkDestroyPipelineCache(device.handle(), cache, nullptr);
}

}  // namespace
