// Whole frames of heads: the module's and others', time beside error.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/device.h"
#include "common/plot.h"
#include "frame_sources.h"
#include "options.h"
#include "replay/replay.h"
#include "report.h"

namespace pellucid::bench {

// Adds the rows of every source to `report`, section "frames". Returns a plot a frame, under the frames'
// size.
std::map<std::string, std::vector<harness::Plot>> measureFrames(harness::Device& device,
                                                                const harness::Context& context,
                                                                const std::vector<FrameSource>& sources,
                                                                const FrameOptions& options, int repeat,
                                                                Report& report);

}  // namespace pellucid::bench
