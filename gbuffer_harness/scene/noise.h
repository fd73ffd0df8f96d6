// Seeded gradient noise and random numbers, the same on every platform.
#pragma once

#include <array>
#include <cstdint>
#include <random>

namespace pellucid::harness {

// Uniform in [0, 1). std::uniform_real_distribution differs between standard libraries.
class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * (*this)(); }

private:
  std::mt19937 engine_;
};

// Perlin's improved noise (2002) in two dimensions, and sums of its octaves.
class Noise {
public:
  explicit Noise(unsigned seed);
  double operator()(double x, double y) const;  // about -1 .. 1, period 256
  // Octaves of doubled frequency and halved amplitude.
  double fractal(double x, double y, int octaves) const;

private:
  std::array<std::uint8_t, 512> permutation_;
};

}  // namespace pellucid::harness
