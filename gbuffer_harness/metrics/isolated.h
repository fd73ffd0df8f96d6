// Single pixels that stick out of their surface: dots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "metrics/masked_image.h"
#include "metrics/surface.h"

namespace pellucid::harness {

struct IsolatedPixels {
  std::size_t bright = 0, dark = 0;  // pixels; one that is bright in one channel and dark in another is both
  std::size_t count = 0;             // pixels that are either
  Mask marks;                        // one value a pixel; 1: bright, 2: dark, 3: both

  // Pixels that are isolated here and not in the same way in another image of the size.
  std::size_t alone(const IsolatedPixels& other) const;
};

constexpr double kIsolated = 1.3, kNearlyIsolated = 1.1;

// A pixel is isolated when one of its channels is above `contrast` times the largest, or below 1/contrast of
// the least, of the neighbors that show its surface, of which there must be at least 5 of 8 (as along a
// silhouette). The brighter of the two values must be above kDarkestPart of that channel's RMS over the mask.
// Pixels that do not count are neither judged nor neighbors. Throws InputError when the image has not three
// channels and the surfaces' size.
IsolatedPixels findIsolated(const Image& image, const Surfaces& surfaces, const Mask& mask,
                            double contrast = kIsolated);

// The image in sRGB at an exposure and half as bright, with a frame around each isolated pixel: red around
// bright ones, blue around dark ones, magenta around pixels that are both. 3 bytes a pixel, row 0 first.
std::vector<std::uint8_t> markIsolated(const Image& image, const IsolatedPixels& isolated, float exposure);

}  // namespace pellucid::harness
