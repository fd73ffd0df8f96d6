// The surface points that a capture's pixels show, and those that they hide.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/path_tracer/emitters.h"
#include "reference/path_tracer/trace_scene.h"

namespace pellucid::harness::reference {

struct VisibleSurface {
  int width = 0, height = 0;
  std::vector<std::optional<SurfacePoint>> points;  // row 0 first; absent: no material
  std::size_t missed = 0;                           // pixels with a material where no ray met the surface
};

// Rays through the centers of the capture's pixels that have a material: where its G-buffer was sampled. A
// ray that misses at a silhouette is moved by less than half a pixel. Throws InputError for a left-handed
// camera.
VisibleSurface visibleSurface(const Capture& capture, const TraceScene& scene);

// The points at which the rays to the visible points leave the bodies again. Absent where the ray meets an
// opaque surface first.
VisibleSurface hiddenSurface(const Capture& capture, const TraceScene& scene, const VisibleSurface& visible);

// Irradiance (R, G, B) at each pixel, the mean of `count` samples: for lights that a rasterizer cannot draw.
// 0 where there is no point. Same input, same bits.
Image tracedIrradiance(const VisibleSurface& surface, const TraceScene& scene, const Emitters& emitters,
                       int count);

}  // namespace pellucid::harness::reference
