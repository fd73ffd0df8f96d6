// Properties of a capture for which its results are wrong.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "replay/frame.h"

namespace pellucid::harness {

// A plan leaves out the levels of the diffusion that radii at settings.nearestDistance do not reach: nothing
// that diffuses may lie nearer by more than the rounding of depths, 1e-4 of it. Throws InputError, naming the
// nearest pixel. A setting of 0 promises nothing, and an orthographic camera needs no promise.
void requireNearestDistance(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                            const ReplaySettings& settings);

// A sentence for each material whose transport mean free path, 1 / (reduced scattering + absorption), is more
// than a quarter of a size. It is that of the material's largest piece that the camera sees whole: the middle
// one of width, height and thickness. Light then leaves by the sides, where T(d) of a slab and the diffusion
// of a half-space have none. `materials`: compiled.
std::vector<std::string> thinBodies(const Capture& capture, const std::vector<PellucidMaterial>& materials);

}  // namespace pellucid::harness
