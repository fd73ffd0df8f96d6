// The setting nearest-distance against a capture.
#pragma once

#include <vector>

#include "capture/capture.h"
#include "replay/frame.h"

namespace pellucid::harness {

// A plan leaves out the levels of the diffusion that radii at settings.nearestDistance do not reach: nothing
// that diffuses may lie nearer by more than the rounding of depths, 1e-4 of it. Throws InputError, naming the
// nearest pixel. A setting of 0 promises nothing, and an orthographic camera needs no promise.
void requireNearestDistance(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                            const ReplaySettings& settings);

}  // namespace pellucid::harness
