// Views before they are recorded: what is refused, and their constants.
#pragma once

#include <span>

#include "context.h"
#include "pellucid/pellucid_views.h"

namespace pellucid {

// Checks the views and writes their constants. Errors go to the context's message; `named`: with the view's
// index before the field.
PellucidResult prepareViews(const PellucidContext& context, std::span<const PellucidView> views, bool named);

}  // namespace pellucid
