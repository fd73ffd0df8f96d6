#pragma once

#include <array>

#include "findings.h"
#include "pellucid/pellucid.h"
#include "pipelines.h"
#include "vk_table.h"

// Immutable once pellucidCreateContext has returned, but for the pipelines that pellucidCreatePipelines adds.
struct PellucidContext {
  VkDevice device = VK_NULL_HANDLE;
  VkAllocationCallbacks allocator{};
  bool hasAllocator = false;
  pellucid::VkTable vk;
  PellucidContextDesc desc{};  // its `allocator` may be gone
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
  std::array<VkPipeline, pellucid::kPipelineCount> pipelines{};  // NULL: not among desc.uses, or not made yet

  const VkAllocationCallbacks* callbacks() const { return hasAllocator ? &allocator : nullptr; }
};

namespace pellucid {

// Reports a call that failed; the result of that.
PellucidResult vulkanError(Findings& out, const char* call, VkResult result);

}  // namespace pellucid
