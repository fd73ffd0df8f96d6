// Photons through plane layers between smooth faces: the independent answer the transport solver is held to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace monte_carlo {

struct Layer {
  double scattering, absorption;  // 1/mm, not reduced
  double thickness;               // mm; infinity only as the last
};

struct Setup {
  std::vector<Layer> layers;
  double ior = 1;
  double g = 0;                  // Henyey-Greenstein
  bool normalIncidence = false;  // else Lambertian
};

struct Exit {
  bool transmitted;
  double radius, weight;  // distance from the point of entry along the face; share of a photon
};

// SplitMix64 (Steele et al. 2014): the same numbers on every platform.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {  // in (0, 1)
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  }

private:
  std::uint64_t state_;
};

inline double reflectance(double outside, double inside, double ior) {
  const double s = (outside - ior * inside) / (outside + ior * inside);
  const double p = (ior * outside - inside) / (ior * outside + inside);
  return (s * s + p * p) / 2;
}

// Calls exit(Exit) for light that leaves; weights are relative to the photons sent, those reflected without
// entering included and never reported.
template <class OnExit>
void trace(const Setup& setup, int photons, std::uint64_t seed, OnExit&& exit) {
  Random random(seed);
  const double share = 1.0 / photons;
  const auto last = setup.layers.size() - 1;
  for (int photon = 0; photon < photons; ++photon) {
    const double outside = setup.normalIncidence ? 1 : std::sqrt(random());
    const double sine = std::sqrt(1 - outside * outside) / setup.ior;
    double w = std::sqrt(1 - sine * sine), u = sine, v = 0, x = 0, y = 0, z = 0;
    if (random() < reflectance(outside, w, setup.ior)) continue;
    double weight = share;
    std::size_t layer = 0;  // z runs from its top
    double path = -std::log(random());
    while (weight > 0) {
      const Layer& medium = setup.layers[layer];
      const double extinction = medium.scattering + medium.absorption;
      const double limit = w > 0 ? (medium.thickness - z) / w : -z / w;
      const double step = std::min(path / extinction, limit);
      x += u * step;
      y += v * step;
      z += w * step;
      if (path / extinction > limit) {
        path -= limit * extinction;
        const bool down = w > 0;
        if (down ? layer < last : layer > 0) {
          layer = down ? layer + 1 : layer - 1;
          z = down ? 0 : setup.layers[layer].thickness;
          continue;
        }
        const double refracted = setup.ior * std::sqrt(1 - w * w);
        const double r =
            refracted < 1 ? reflectance(std::sqrt(1 - refracted * refracted), std::abs(w), setup.ior) : 1;
        if (random() >= r) {
          exit(Exit{down, std::hypot(x, y), weight});
          break;
        }
        w = -w;
        z = down ? medium.thickness : 0;
        continue;
      }
      weight *= medium.scattering / extinction;
      if (weight < 1e-3 * share) weight = random() < 0.1 ? weight * 10 : 0;
      const double g = setup.g, t = (1 - g * g) / (1 - g + 2 * g * random());
      const double cosine = g == 0 ? 2 * random() - 1 : (1 + g * g - t * t) / (2 * g);
      const double turn = 2 * std::numbers::pi * random(), s = std::sqrt(std::max(0.0, 1 - cosine * cosine));
      // The frame of Duff et al. 2017.
      const double sign = std::copysign(1.0, w), a = -1 / (sign + w), b = u * v * a;
      const double p = s * std::cos(turn), q = s * std::sin(turn);
      const double nu = p * (1 + sign * u * u * a) + q * b + cosine * u;
      const double nv = p * sign * b + q * (sign + v * v * a) + cosine * v;
      const double nw = -p * sign * u - q * v + cosine * w;
      const double length = std::sqrt(nu * nu + nv * nv + nw * nw);
      u = nu / length;
      v = nv / length;
      w = nw / length;
      path = -std::log(random());
    }
  }
}

struct Totals {
  double reflected = 0, transmitted = 0;
};

inline Totals totals(const Setup& setup, int photons, std::uint64_t seed) {
  Totals sum;
  trace(setup, photons, seed,
        [&](const Exit& e) { (e.transmitted ? sum.transmitted : sum.reflected) += e.weight; });
  return sum;
}

// What a half-plane of light leaves at distance x inside its edge, from the exits of a point of light:
// the share of a ring of radius r nearer than x to it.
inline std::vector<double> edge(const Setup& setup, int photons, std::uint64_t seed,
                                const std::vector<double>& x) {
  std::vector<double> step(x.size(), 0.0);
  double total = 0;
  trace(setup, photons, seed, [&](const Exit& e) {
    total += e.weight;
    for (std::size_t i = 0; i < x.size(); ++i)
      step[i] += e.weight * (x[i] >= e.radius ? 1 : 1 - std::acos(x[i] / e.radius) / std::numbers::pi);
  });
  for (double& value : step) value /= total;
  return step;
}

}  // namespace monte_carlo
