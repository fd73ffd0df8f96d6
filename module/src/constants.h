#pragma once

#include "frame.h"

namespace pellucid {

// The constants of a frame's plan into a slice of `size` bytes. PELLUCID_ERROR_INVALID_ARGUMENT where the
// plan is of another frame, PELLUCID_ERROR_BUFFER_TOO_SMALL where the slice does not hold them.
PellucidResult writeConstants(const FrameFacts& facts, const PellucidPlan& plan, void* mapped, size_t size);

}  // namespace pellucid
