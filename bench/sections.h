// The sections that main() runs, each of which adds its rows to the report.
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

// ---- frames: whole frames of heads, the module's and others', time beside error

// Adds the rows of every source. Returns a plot a frame, under the frames' size.
std::map<std::string, std::vector<harness::Plot>> measureFrames(harness::Device& device,
                                                                const harness::Context& context,
                                                                const std::vector<FrameSource>& sources,
                                                                const FrameOptions& options, int repeat,
                                                                Report& report);

// ---- paths: how much results change along paths of a camera, of lights and of a body

// The portrait of FrameOptions::models along each path of raster/camera_path.h: rows of the module without and with an
// anchor, accumulated, and with 64 samples, and of the published passes. Then times of frames that accumulate. Throws
// InputError where the models are missing.
void measurePaths(harness::Device& device, const harness::Context& context, const FrameOptions& options, int repeat,
                  Report& report);

// ---- thesis: tables 5.1 to 5.3 of Whelan 2009, a head and a light that turn, pass by pass

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

// ---- context creation: the module's context compiles every pipeline, or those that its uses ask for

// In processes of their own, since drivers also keep compiled shaders in memory: without a driver cache, with
// one that a process before has filled, and from a VkPipelineCache that a process before has saved, without a
// driver cache. Adds the rows of the section "context creation", wall-clock time, of `repeat` processes each;
// the first kind is measured once, with all pipelines and with those of a default frame.
void measureContextCreation(const std::string& device, int repeat, Report& report);

// Runs in such a process: creates the context once and prints wall-clock and CPU microseconds.
int createContext(const Options& options);

}  // namespace pellucid::bench
