// Bytes as a frame with its arrays: a random frame of the stress command that words are written over.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pellucid/pellucid_thesis.h"
#include "replay/frame.h"

namespace pellucid::fuzz {

// Arrays are as long as the frame says and end where they end, so that AddressSanitizer sees every read past
// them.
class FrameInput {
public:
  // The first kHeaderBytes say which random frame it is and how many there are of everything, then each
  // kEditBytes write one word of a struct: which struct, which of the array, which word, and the value or the
  // number of an extreme one. `edits`: how many of them are applied.
  static constexpr size_t kHeaderBytes = 8, kEditBytes = 8;
  FrameInput(std::span<const uint8_t> bytes, size_t edits);

  PellucidFrame frame;
  uint8_t choice = 0;  // a byte of the header that the frame does not use

private:
  harness::FrameData data_;
};

}  // namespace pellucid::fuzz
