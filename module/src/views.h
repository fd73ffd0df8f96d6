// Views before they are recorded: what is refused.
#pragma once

#include <span>

#include "context.h"
#include "pellucid/pellucid_views.h"

namespace pellucid {

// Errors go to the context's message; `named`: with the view's index before the field.
PellucidResult checkViews(const PellucidContext& context, std::span<const PellucidView> views, bool named);

}  // namespace pellucid
