#pragma once

#include <array>

#include "findings.h"
#include "pass.h"
#include "pellucid/pellucid.h"
#include "vk_table.h"

// Immutable once pellucidCreateContext has returned, but for the pipelines that pellucidCreatePipelines adds.
struct PellucidContext {
  VkDevice device = VK_NULL_HANDLE;
  VkAllocationCallbacks allocator{};
  bool hasAllocator = false;
  pellucid::VkTable vk;
  PellucidContextDesc desc{};  // its `allocator` may be gone
  // By pass. A pipeline is NULL that is not among desc.options.uses, or not made yet.
  std::array<VkDescriptorSetLayout, pellucid::kMostPasses> setLayouts{};
  std::array<VkPipelineLayout, pellucid::kMostPasses> pipelineLayouts{};
  std::array<VkPipeline, pellucid::kMostPasses> pipelines{};

  const VkAllocationCallbacks* callbacks() const { return hasAllocator ? &allocator : nullptr; }
};

namespace pellucid {

// Reports a call that failed; the result of that.
PellucidResult vulkanError(Findings& out, const char* call, VkResult result);

}  // namespace pellucid
