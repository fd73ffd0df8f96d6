// Hashes of the frame that a plan was made from, so that recording can refuse another frame by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pellucid {

struct FrameFacts;

// Parts of a frame that a plan is made from.
enum class FramePart {
  Size,      // imageExtent, renderRect
  Camera,    // metersPerUnit, clipFromView, viewFromWorld
  Images,    // which optional images are given
  Settings,  // all fields of other kinds
  Materials,
  Lights,
  ShadowMaps,
  ShadowImages,  // their number
  Count
};

// By FramePart.
using FrameHash = std::array<uint32_t, static_cast<size_t>(FramePart::Count)>;

// Hashes all that a frame holds but its views. Equal frames have equal hashes; others differ but for one in
// 2^32.
FrameHash hashOf(const FrameFacts& facts);

const char* nameOf(FramePart part);

}  // namespace pellucid
