#include "output_format.h"

namespace pellucid {
namespace {

// SPIR-V 1.3, sections 3.11, 3.31 and 3.32.
constexpr uint32_t kHeaderWords = 5, kOpTypeImage = 25, kOpCapability = 17;
constexpr uint32_t kCapabilityShader = 1, kCapabilityWriteWithoutFormat = 56;
constexpr uint32_t kUnknown = 0, kRgba32f = 1, kRgba16f = 2, kStorageImage = 2;

}  // namespace

void fixOutputFormat(uint32_t* words, std::size_t wordCount, bool wide) {
  for (std::size_t at = kHeaderWords; at < wordCount;) {
    const uint32_t opcode = words[at] & 0xFFFF, count = words[at] >> 16;
    if (count == 0 || count > wordCount - at) return;
    uint32_t* operands = words + at + 1;
    // A capability may be declared twice.
    if (opcode == kOpCapability && operands[0] == kCapabilityWriteWithoutFormat)
      operands[0] = kCapabilityShader;
    // result, sampled type, dim, depth, arrayed, multisampled, sampled, format
    if (opcode == kOpTypeImage && operands[6] == kStorageImage && operands[7] == kUnknown)
      operands[7] = wide ? kRgba32f : kRgba16f;
    at += count;
  }
}

}  // namespace pellucid
