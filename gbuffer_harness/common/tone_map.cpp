#include "common/tone_map.h"

#include <algorithm>
#include <cmath>

namespace pellucid::harness {

namespace {

using Rgb = std::array<double, 3>;
using Rows = std::array<Rgb, 3>;

// Sobotka 2022, github.com/sobotka/AgX-S2O3: Rec. 709 to primaries that lie farther in. The way back, as
// Wrensch 2023, "Minimal AgX Implementation", has it.
constexpr Rows kInset = {{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                          {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                          {0.0423756549057051, 0.0784336, 0.879142973793104}}};
constexpr Rows kOutset = {{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                           {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                           {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
constexpr double kLeastStops = -12.47393,
                 kMostStops = 4.026069;  // log2 of light; 0.18 is 10 stops above the least
constexpr double kDisplayPower = 2.2;

Rgb times(const Rows& rows, const Rgb& color) {
  Rgb result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = rows[i][0] * color[0] + rows[i][1] * color[1] + rows[i][2] * color[2];
  return result;
}

// The contrast curve on stops as 0..1: slope 2 at middle gray, which becomes 0.5; on both sides a hyperbola
// x / (1 + x^p)^(1/p), scaled to end at 0 and at 1.
double agxContrast(double x) {
  constexpr double kPivot = 10 / 16.5, kGray = 0.5, kSlope = 2, kToe = 3, kShoulder = 3.25;
  const bool toe = x < kPivot;
  const double power = toe ? kToe : kShoulder;
  const double across = toe ? kPivot : 1 - kPivot, up = toe ? kGray : 1 - kGray;
  const double scale =
      std::pow(std::pow(kSlope * across, -power) * (std::pow(kSlope * across / up, power) - 1), -1 / power);
  const double t = kSlope * std::abs(x - kPivot) / scale;
  const double y = scale * t / std::pow(1 + std::pow(t, power), 1 / power);
  return toe ? kGray - y : kGray + y;
}

double agxEncoded(double light) {
  const double stops = light > 0 ? std::log2(light) : kLeastStops;
  return agxContrast((std::clamp(stops, kLeastStops, kMostStops) - kLeastStops) / (kMostStops - kLeastStops));
}

Rgb agx(const Rgb& color) {
  Rgb encoded = times(kInset, color);
  for (double& value : encoded) value = agxEncoded(value);
  encoded = times(kOutset, encoded);
  for (double& value : encoded) value = std::pow(std::clamp(value, 0.0, 1.0), kDisplayPower);
  return encoded;
}

// Narkowicz 2016, "ACES Filmic Tone Mapping Curve".
double aces(double x) { return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

}  // namespace

const std::vector<std::string>& toneMapNames() {
  static const std::vector<std::string> names = {"none", "agx", "aces"};
  return names;
}

std::array<float, 3> toneMapped(ToneMap map, std::array<float, 3> color) {
  if (map == ToneMap::None) return color;
  Rgb light;
  for (std::size_t i = 0; i < 3; ++i) light[i] = std::max(static_cast<double>(color[i]), 0.0);
  if (map == ToneMap::Agx)
    light = agx(light);
  else
    for (double& value : light) value = aces(value);
  for (std::size_t i = 0; i < 3; ++i) color[i] = static_cast<float>(light[i]);
  return color;
}

}  // namespace pellucid::harness
