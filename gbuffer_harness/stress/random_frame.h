// Random frames: what engines may have, and what floats can hold.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "replay/frame.h"

namespace pellucid::harness::stress {

// Materials that frames draw from: compiling one takes longer than a frame.
class MaterialPool {
public:
  MaterialPool();

  struct Entry {
    MaterialSource source;
    bool tame;
    // By TransmittanceChoice.
    std::array<PellucidMaterial, 4> compiled;
  };
  const std::vector<Entry>& entries() const { return entries_; }

private:
  std::vector<Entry> entries_;
};

struct FrameLimits {
  std::optional<std::uint32_t> gatherSamples;  // of all frames; none: any
  int pixels = 65536;                          // of the largest frame; few frames are above 64 x 64
  int side = 16384;  // of the longest frame: what images of any Vulkan device may have is less or more
};

struct StressFrame {
  std::uint64_t seed = 0, index = 0;
  bool wild = false;                        // values that floats can hold, and not only those of engines
  Capture capture;                          // irradiance is RGBA, whose alpha capture files do not hold
  std::vector<PellucidMaterial> materials;  // with T(d) exchanged as `transmittance` says
  TransmittanceChoice transmittance = TransmittanceChoice::Material;
  ReplaySettings settings;   // .transmittance is Material, as `materials` have it already
  std::string notInCapture;  // what a capture file cannot hold besides alphas; empty: nothing
};

// Same seed and index, same frame. Even indices are tame, odd ones wild.
StressFrame randomFrame(std::uint64_t seed, std::uint64_t index, const MaterialPool& pool,
                        const FrameLimits& limits);

// 1 for each pixel that the pass owns: with a material and inside the rect.
std::vector<std::uint8_t> ownedPixels(const StressFrame& frame);

}  // namespace pellucid::harness::stress
