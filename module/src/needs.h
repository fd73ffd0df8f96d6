#pragma once

#include "frame.h"

namespace pellucid {

// pellucidGetImageNeeds of a frame that was read.
PellucidResult imageNeeds(const FrameFacts& facts, uint32_t* count, PellucidImageNeed* needs);

}  // namespace pellucid
