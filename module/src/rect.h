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
  if (frame.options.renderRect[2] == 0) return {0, 0, frame.imageExtent[0], frame.imageExtent[1]};
  return {frame.options.renderRect[0], frame.options.renderRect[1], frame.options.renderRect[2], frame.options.renderRect[3]};
}

// Parts that cover a length, the last of them perhaps cut short.
constexpr uint32_t parts(uint32_t length, uint32_t part) { return (length + part - 1) / part; }

// Cells of `side` pixels, aligned to the image, that the pixels [first, first + count) lie in.
constexpr uint32_t cellsAlong(uint32_t first, uint32_t count, uint32_t side) {
  return (first + count - 1) / side - first / side + 1;
}

}  // namespace pellucid
