// Random frames: what engines may have, and what floats can hold.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "replay/frame.h"

namespace pellucid::harness::stress {

// SplitMix64 (Steele, Lea and Flood 2014). Its numbers are the same on every machine; the distributions of
// the standard library differ.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // Numbers of one item of a sequence, and of no other.
  Random(std::uint64_t seed, std::uint64_t index)
      : state_(Random(seed).bits() ^ (index * 0xD1342543DE82EF95u)) {
    state_ = bits();
  }

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double real() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
  double real(double least, double most) { return least + (most - least) * real(); }
  // Even over the logarithm; both > 0.
  double magnitude(double least, double most) { return least * std::exp2(real() * std::log2(most / least)); }
  int whole(int least, int most) {  // both may come
    return least + static_cast<int>(bits() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool chance(double probability) { return real() < probability; }
  template <class T>
  T of(std::initializer_list<T> choices) {
    return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
  }

private:
  std::uint64_t state_;
};

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
