// How much results change along paths of a camera, of lights and of a body.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/plot.h"
#include "options.h"
#include "replay/replay.h"
#include "report.h"

namespace pellucid::bench {

// The portrait of FrameOptions::models along each path of raster/camera_path.h: rows of the module without and with an
// anchor, accumulated, and with 64 samples, and of the published passes. Then times of frames that accumulate. Returns
// plots of each frame's change by path. Throws InputError where the models are missing.
std::map<std::string, std::vector<harness::Plot>> measurePaths(harness::Device& device, const harness::Context& context,
                                                               const FrameOptions& options, int repeat, Report& report);

}  // namespace pellucid::bench
