// Tables 5.1 to 5.3 of Whelan 2009: a head and a light that turn, pass by pass.
#pragma once

#include <filesystem>

#include "options.h"
#include "replay/replay.h"
#include "report.h"

namespace pellucid::bench {

// Draws head_views.glb of options.models at the first of options.sizes (default 1280x720, on a software
// device 256x144), under a point light with one shadow map of options.shadowSize (default 1024, on a software
// device 256). Throws InputError without models.
void measureThesis(harness::Device& device, const harness::Context& context, const FrameOptions& options,
                   int repeat, Report& report);

}  // namespace pellucid::bench
