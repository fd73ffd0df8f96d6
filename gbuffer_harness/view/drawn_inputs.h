// Frames of what the rasterizer drew, without a way over the host.
#pragma once

#include <memory>

#include "raster/drawn_frame.h"
#include "replay/inputs.h"

namespace pellucid::harness {

// Images that a frame of these settings reads. Nothing goes to the host, but for what is to be stored in
// ways that no engine's images have here: normals in view space, distances in shadow maps, maps drawn as an
// engine does or in one image, other formats than floats and halves.
std::shared_ptr<const InputImages> drawnInputs(const DrawnFrame& drawn, const ReplaySettings& settings);

}  // namespace pellucid::harness
