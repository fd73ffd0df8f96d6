// A pass as far as it is the same in all frames: its pipeline, and the bindings that it reads and writes.
#pragma once

#include <cstddef>
#include <span>

#include "bindings.h"

namespace pellucid {

// Statistics that a pass's groups count for.
enum class Counted { Nothing, Blocks, EntryPoints, Probes };

struct Pass {
  const char* pipeline;  // name
  std::span<const uint32_t> words;
  std::span<const uint32_t> wordsOfArrays = {};  // where shadow images are layers of arrays; empty: the same
  uint32_t uses;                                 // PellucidUse bits, all of which it takes to make it
  BindingSet reads, writes;
  std::span<const PellucidSpecialization> constants = {};
  Counted counted = Counted::Nothing;

  constexpr BindingSet bindings() const { return reads | writes; }
  std::span<const uint32_t> wordsFor(VkImageViewType shadowViewType) const {
    return shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY && !wordsOfArrays.empty() ? wordsOfArrays : words;
  }
};

// All passes. PellucidDispatch::pipeline is an index.
std::span<const Pass* const> allPasses();
inline constexpr size_t kMostPasses = 32;

// The most bindings of the type that a pass has, and the most of all types.
uint32_t mostBindings(VkDescriptorType type);
uint32_t mostBindings();

}  // namespace pellucid
