// Captures from disk.
#pragma once

#include <filesystem>

#include "capture/capture.h"
#include "capture/manifest.h"

namespace pellucid::harness {

// Reads a manifest (readManifest) and every image it names. All screen-sized buffers have one size,
// the EXR files' display window. A shadow map is the display window of a file of
// one part; in a file of several parts, which OpenEXR gives one display window in common, its data window.
// Pixels that a data window leaves out hold nothing: 0, material 0, kNoDepth for viewZ and distance; a device
// depth must cover its display window, because no device value means "nothing". Depths are otherwise kept as
// stored. Throws InputError naming file, field and value.
Capture readCapture(const std::filesystem::path& path);

// The same for a manifest already read.
Capture readCapture(const Manifest& manifest);

}  // namespace pellucid::harness
