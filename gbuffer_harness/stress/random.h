// Pseudo-random numbers that are the same on every machine, which the standard library's distributions are
// not.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace pellucid::harness::stress {

// SplitMix64 (Steele, Lea and Flood 2014).
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

}  // namespace pellucid::harness::stress
