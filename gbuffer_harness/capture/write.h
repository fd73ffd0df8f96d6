// Captures to disk.
#pragma once

#include <filesystem>

#include "capture/capture.h"

namespace pellucid::harness {

// Storage of irradiance, albedo and truth. Depths are always 32-bit floats: half floats have
// 11 bits, a millimeter in two meters.
enum class ColorFormat { Half, Float };

// Writes one EXR with an embedded manifest: part "screen" holds the screen-sized buffers, part
// "shadowMap<i>" the map of light i, "shadowMap<i>.<k>" of several. With ColorFormat::Float readCapture gives
// back the same bits; equal captures make equal files. Throws InputError for a value that the format cannot
// hold, or when the file cannot be written.
void writeCapture(const Capture& capture, const std::filesystem::path& exr,
                  ColorFormat color = ColorFormat::Float);

}  // namespace pellucid::harness
