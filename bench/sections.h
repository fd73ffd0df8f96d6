// The sections that main() runs, each of which adds its rows to the report.
#pragma once

#include <string>
#include <vector>

#include "common/device.h"
#include "frame_sources.h"
#include "options.h"
#include "replay/replay.h"
#include "report.h"

namespace pellucid::bench {

// ---- frames: whole frames of heads, the module's and others', time beside error

// Adds the rows of every source.
void measureFrames(harness::Device& device, const harness::Context& context,
                   const std::vector<FrameSource>& sources, const FrameOptions& options, int repeat,
                   Report& report);

// ---- paths: how much results change along paths of a camera, of lights and of a body

// The portrait of FrameOptions::models along each path of raster/camera_path.h: rows of the module without
// and with an anchor, accumulated, and with 64 samples, and of the published passes. Then times of frames
// that accumulate. Throws InputError where the models are missing.
void measurePaths(harness::Device& device, const harness::Context& context, const FrameOptions& options,
                  int repeat, Report& report);

// ---- context creation: the module's context compiles every pipeline, or those that its uses ask for

// In processes of their own, since drivers also keep compiled shaders in memory: without a driver cache, with
// one that a process before has filled, and from a VkPipelineCache that a process before has saved, without a
// driver cache. Adds the rows of the section "context creation", wall-clock time, of `repeat` processes each;
// the first kind is measured once, with all pipelines and with those of a default frame.
void measureContextCreation(const std::string& device, int repeat, Report& report);

// Runs in such a process: creates the context once and prints wall-clock and CPU microseconds.
int createContext(const Options& options);

}  // namespace pellucid::bench
