// Light of a captured scene that rays bring: environments and spheres.
#pragma once

#include "cli/capture_options.h"
#include "reference/path_tracer/emitters.h"
#include "reference/path_tracer/trace_scene.h"

namespace pellucid::harness {

// Whether a rasterizer or a caster of single rays leaves some of the light out.
bool needsTracing(const std::vector<Light>& lights, const std::optional<Environment>& environment);

// Adds to the capture's irradiance what the environment and lights that have a radius bring.
void addTracedLight(Capture& capture, const reference::TraceScene& scene,
                    const std::optional<Environment>& environment);

}  // namespace pellucid::harness
