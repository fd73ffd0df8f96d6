// Channels of a capture's file that a result keeps.
#pragma once

#include <deque>
#include <vector>

#include "capture/exr.h"
#include "capture/manifest.h"

namespace pellucid::harness {

struct KeptLayers {
  std::deque<Image> images;  // its elements stay where they are
  std::vector<ExrChannel> channels;
};

// Every channel of the file that holds the irradiance, in parts of that one's size, but for R, G and B, and
// the alpha of the irradiance's layer as A. Nothing for a constant. Numbers above 2^24 of uint channels are
// rounded. Throws InputError.
KeptLayers readOtherLayers(const BufferSource& irradiance);

}  // namespace pellucid::harness
