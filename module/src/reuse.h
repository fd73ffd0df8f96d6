// Whether a frame takes the light that came through from an earlier one. Pure.
#pragma once

#include "pellucid/pellucid.h"

namespace pellucid {

// The frame keeps its transmitted light in frame.history.
bool keepsHistory(const PellucidFrame& frame);

// What it keeps are the points of a gather, which are added to the frame's own diffused light.
bool keepsProbes(const PellucidFrame& frame);

// For a frame that keeps its transmitted light: whether `kept`, of the previous plan, stands in for this
// frame's. `now` becomes what the history holds after the frame.
bool decideReuse(const PellucidFrame& frame, const PellucidHistory& kept, PellucidHistory* now);

}  // namespace pellucid
