// 8-bit pictures of float images, for people to look at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/image.h"

namespace pellucid::harness {

// `rgb`: width * height * 3 bytes, row 0 at the top. Throws InputError when the file cannot be written.
void writePng(const std::filesystem::path& path, int width, int height, const std::vector<std::uint8_t>& rgb);

// A screenshot: RGBA, 0..1, values of the screen; a whole file or none. Throws InputError likewise.
void savePicture(const std::filesystem::path& png, const Image& screen);

// Linear to display: times `exposure`, the exact sRGB curve (IEC 61966-2-1), clamped to 0..255.
// One channel becomes gray, channels past the third are left out. NaN and infinity are magenta.
std::vector<std::uint8_t> toSrgb(const Image& image, float exposure = 1.0f);

// The factor that brings the 99th percentile of the values above 0 to 0.8: below white, above the middle.
float autoExposure(const Image& image);

// Images of one size and channel count in rows of `columns`, the first at the top left, with black gaps of
// `gap` pixels; what the last row lacks is black. columns: >= 1.
Image contactSheet(const std::vector<const Image*>& images, int columns, int gap = 4);

}  // namespace pellucid::harness
