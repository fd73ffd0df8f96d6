#pragma once

#include "pellucid/pellucid.h"

namespace pellucid {

// Everything a plan relies on; image views are not looked at. `fn` may be null.
PellucidResult checkFrame(const PellucidFrame* frame, PellucidMessageFn fn, void* user);

// The views a recording needs.
PellucidResult checkViews(const PellucidFrame& frame, PellucidMessageFn fn, void* user);

}  // namespace pellucid
