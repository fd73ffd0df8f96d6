// A way to do a part of the frame, the module's or another, as the tables compare them.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <string>

#include "common/image.h"

namespace pellucid::bench {

struct Variant {
  std::string name;
  uint32_t dispatches, barriers;
  double bytesPerPixel;                         // least traffic: what each dispatch reads, once, and writes
  std::function<void(VkCommandBuffer)> record;  // the barriers within, none around
  std::function<harness::Image()> output;       // RGB; after a run
  std::uint64_t transientBytes = 0;             // of its images between dispatches
};

}  // namespace pellucid::bench
