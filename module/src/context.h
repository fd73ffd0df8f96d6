#pragma once

#include <array>

#include "pellucid/pellucid.h"
#include "pipelines.h"
#include "vk_table.h"

// Immutable once pellucidCreateContext has returned.
struct PellucidContext {
  VkDevice device = VK_NULL_HANDLE;
  VkAllocationCallbacks allocator{};
  bool hasAllocator = false;
  pellucid::VkTable vk;
  PellucidMessageFn message = nullptr;
  void* messageUser = nullptr;
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
  std::array<VkPipeline, pellucid::kPipelineCount> pipelines{};  // NULL: not among desc.uses
  VkFormat outputFormat = VK_FORMAT_UNDEFINED;                   // of all frames; UNDEFINED: any
  VkImageViewType shadowViewType = VK_IMAGE_VIEW_TYPE_2D;        // of all frames' shadow images
  bool lightTables = false;                                      // frames may have some

  const VkAllocationCallbacks* callbacks() const { return hasAllocator ? &allocator : nullptr; }
};
