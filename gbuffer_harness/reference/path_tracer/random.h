// Random numbers of one path: a stream that seed, pixel and sample name, whichever thread walks it.
#pragma once

#include <cstdint>

namespace pellucid::harness::reference {

class PathRandom {
public:
  PathRandom(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : state_(mix(mix(mix(seed) ^ pixel) ^ sample)) {}

  // [0, 1)
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

private:
  // SplitMix64 (Steele, Lea & Flood 2014).
  static std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15u); }

  std::uint64_t state_;
};

}  // namespace pellucid::harness::reference
