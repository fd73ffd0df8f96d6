#pragma once

#include <cstdint>

#include "pellucid/pellucid.h"

namespace pellucid {

// Pixels.
struct Rect {
  uint32_t x, y, width, height;
};

// The part of the image that is rendered.
inline Rect renderRect(const PellucidFrame& frame) {
  if (frame.renderRect[2] == 0) return {0, 0, frame.imageExtent[0], frame.imageExtent[1]};
  return {frame.renderRect[0], frame.renderRect[1], frame.renderRect[2], frame.renderRect[3]};
}

}  // namespace pellucid
