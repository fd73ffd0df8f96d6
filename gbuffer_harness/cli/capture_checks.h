// Properties of a capture for which its results are wrong.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

// A sentence for each material whose transport mean free path, 1 / (reduced scattering + absorption), is more
// than a quarter of a size. It is that of the material's largest piece that the camera sees whole: the middle
// one of width, height and thickness. Light then leaves by the sides, where T(d) of a slab and the diffusion
// of a half-space have none. `materials`: compiled.
std::vector<std::string> thinBodies(const Capture& capture, const std::vector<PellucidMaterial>& materials);

// A sentence for each light whose shadow maps contradict the G-buffer.
std::vector<std::string> strangeMaps(const Capture& capture);

// The module's sentences of a severity about the frame that a replay without options records.
std::vector<std::string> findingsOf(const Capture& capture, const std::vector<PellucidMaterial>& materials, PellucidSeverity severity);

// All warnings: those of the capture's files, of the module about the frame that a replay without options records, of pixels, maps,
// tables and bodies.
std::vector<std::string> warningsOf(const Capture& capture, const std::vector<PellucidMaterial>& materials);

}  // namespace pellucid::harness
