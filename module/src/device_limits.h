// What a device must be able to do.
#pragma once

#include "findings.h"

namespace pellucid {

// Reports the first limit or feature that a context of this description lacks, by its name in Vulkan.
void checkLimits(const PellucidContextDesc& desc, const VkPhysicalDeviceProperties& properties,
                 Findings& out);

}  // namespace pellucid
