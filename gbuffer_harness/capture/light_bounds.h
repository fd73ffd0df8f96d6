// Which lights a replay takes: one rule for manifests, glTF files and the command line.
#pragma once

#include <functional>
#include <string>

#include "capture/capture.h"

namespace pellucid::harness {

// Clamps what lies a rounding beyond its bound (common/bounds.h), so that the light keeps the domains of
// PellucidLight as floats, too, and longer ranges to the longest. Calls fail with the manifest's key and a
// sentence for a value further out; fail must throw.
void fitLight(Light& light, const std::function<void(const char* key, const std::string& sentence)>& fail);

}  // namespace pellucid::harness
