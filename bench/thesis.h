// Tables 5.1 to 5.3 of Whelan 2009: a head and a light that turn, pass by pass.
#pragma once

#include <vector>

#include "options.h"
#include "replay/replay.h"
#include "report.h"

namespace pellucid::bench {

// Draws head_views.glb of options.models at the first of options.sizes (default 1280x720, on a software
// device 256x144), under a point light with one shadow map of options.shadowSize (default 1024, on a software
// device 256). Throws InputError without models.
void measureThesis(harness::Device& device, const harness::Context& context, const FrameOptions& options,
                   int repeat, Report& report);

// Shares of the frames in which light that comes through has to be computed.
struct TurntableShares {
  double necessary = 0;         // light can come through (4.7.1)
  double coherent[2] = {0, 0};  // the cosine of camera and light changed by more than kCoherence (4.7.5)
  double both[2] = {0, 0};      // and light can come through
};
inline constexpr double kCoherence[] = {0.005, 0.01};

// A frame's cosine between the camera's axis and the direction to the light, and whether light can come
// through.
struct TurntableFrame {
  double cosine;
  bool necessary;
};
TurntableShares turntableShares(const std::vector<TurntableFrame>& frames);

}  // namespace pellucid::bench
