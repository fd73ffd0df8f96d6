#include "scene/noise.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace pellucid::harness {

namespace {

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Dot product with one of eight directions of the plane.
double gradient(std::uint8_t hash, double x, double y) {
  constexpr double kDiagonal = 0.7071067811865476;
  switch (hash & 7) {
    case 0:
      return x;
    case 1:
      return -x;
    case 2:
      return y;
    case 3:
      return -y;
    case 4:
      return kDiagonal * (x + y);
    case 5:
      return kDiagonal * (x - y);
    case 6:
      return kDiagonal * (y - x);
    default:
      return -kDiagonal * (x + y);
  }
}

}  // namespace

Noise::Noise(unsigned seed) {
  std::iota(permutation_.begin(), permutation_.begin() + 256, std::uint8_t{0});
  Random random(seed);
  for (std::size_t i = 255; i > 0; --i) {
    std::swap(permutation_[i], permutation_[static_cast<std::size_t>(random() * static_cast<double>(i + 1))]);
  }
  for (std::size_t i = 0; i < 256; ++i) permutation_[256 + i] = permutation_[i];
}

double Noise::operator()(double x, double y) const {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto i = static_cast<std::size_t>(static_cast<long long>(fx) & 255);
  const auto j = static_cast<std::size_t>(static_cast<long long>(fy) & 255);
  x -= fx;
  y -= fy;
  const auto corner = [&](std::size_t dx, std::size_t dy) {
    return gradient(permutation_[permutation_[i + dx] + j + dy], x - static_cast<double>(dx),
                    y - static_cast<double>(dy));
  };
  const double u = fade(x);
  const double v = fade(y);
  return std::lerp(std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

double Noise::fractal(double x, double y, int octaves) const {
  double sum = 0;
  double amplitude = 1;
  for (int i = 0; i < octaves; ++i, amplitude /= 2) {
    // Each octave is shifted, or all of them would vanish together at the lattice points.
    sum += amplitude * (*this)(x + 17.3 * i, y + 5.7 * i);
    x *= 2;
    y *= 2;
  }
  return sum;
}

}  // namespace pellucid::harness
