// Bytes as a frame with its arrays: a valid frame that words are written over.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pellucid/pellucid_thesis.h"

namespace pellucid::fuzz {

// Arrays are as long as the frame says and end where they end, so that AddressSanitizer sees every read past
// them.
class FrameInput {
public:
  // The first kHeaderBytes say how many there are of everything, then each kEditBytes write one word of a
  // struct: which struct, which of the array, which word, and the value or the number of an extreme one.
  // `edits`: how many of them are applied.
  static constexpr size_t kHeaderBytes = 8, kEditBytes = 8;
  FrameInput(std::span<const uint8_t> bytes, size_t edits);
  FrameInput(const FrameInput&) = delete;

  PellucidFrame frame;
  uint8_t choice = 0;  // a byte of the header that the frame does not use

private:
  PellucidThesisOptions thesis_;
  std::vector<PellucidMaterial> materials_;
  std::vector<PellucidLight> lights_;
  std::vector<PellucidShadowMap> maps_;
  std::vector<PellucidImage> images_;
  std::vector<float> ambient_;
  std::vector<PellucidLightTable> lightTables_;
};

}  // namespace pellucid::fuzz
