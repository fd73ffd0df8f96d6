// From what the options of a scene say to its capture.
#pragma once

#include "cli/capture_options.h"
#include "common/device.h"
#include "reference/path_tracer/trace_scene.h"

namespace pellucid::harness {

// The capture of a procedural scene with its --ior and --environment. Throws as makeScene() does.
Capture captureScene(const SceneParameters& scene, const CaptureOptions& options);

// The capture that rasterize() draws, and on top of it the irradiance of the environment and of lights that
// have a radius, traced by rays.
RasterResult captureScene(Device& device, const Model& model, const ModelCamera& camera,
                          const RasterOptions& raster, const std::optional<Environment>& environment);

// Adds that irradiance to a capture of the traced scene; nothing where it has neither.
void addTracedLight(Capture& capture, const reference::TraceScene& scene,
                    const std::optional<Environment>& environment);

}  // namespace pellucid::harness
