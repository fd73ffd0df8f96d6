#include "gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "transmittance.h"

namespace pellucid {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kGatherEntries = PELLUCID_GATHER_ENTRIES;

// T(d) of one channel and how fast it spreads sideways.
struct Channel {
  const PellucidMaterial* material;
  int index;
  double slowest;        // kappa, 1/mm
  double extrapolation;  // e: T goes like 1 / sinh(kappa (d + e)); mm, INFINITY for one exponential

  double transmittance(double d) const {
    return pellucid::transmittance(*material, static_cast<size_t>(index), d);
  }
  // Of the lowest mode of a slab of thickness d, 1/mm.
  double decay(double d) const { return std::hypot(slowest, kPi / std::max(d + extrapolation, 1e-3)); }
};

Channel channelOf(const PellucidMaterial& m, int index) {
  Channel c{&m, index, 0, 0};
  const auto p = [&](int i) { return static_cast<double>(m.transmittance[index][i]); };
  const bool exp2 = m.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2;
  // A floor of 1/km keeps media without absorption finite.
  c.slowest = std::max(exp2 && p(2) > 0 ? std::min(p(1), p(3)) : p(1), 1e-6);
  if (!exp2) {
    c.extrapolation = p(2) / c.slowest;
    return c;
  }
  // kappa coth(kappa (d + e)) is the rate of T at half depth.
  const auto t = [&](double d) { return c.transmittance(d); };
  const double half = depthOf(t, 0.5 * t(0), 100 / c.slowest);
  const double a1 = p(0) * std::exp(-p(1) * half), a2 = p(2) * std::exp(-p(3) * half);
  const double excess = (a1 * p(1) + a2 * p(3)) / (a1 + a2) / c.slowest - 1;
  c.extrapolation =
      excess > 1e-6 ? std::max(0.5 * std::log((2 + excess) / excess) / c.slowest - half, 0.0) : INFINITY;
  return c;
}

// (1 - rho) / (1 + rho)
double lossOf(double rho) { return (1 - rho) / (1 + rho); }

// How much more of the light comes back per mean curvature, mm: -d ln rho / d kappa of small losses. On a
// convex surface what diffuses decays like that of a plane with kappa - H, H the mean curvature: of a sphere
// kappa coth(kappa R) - 1 / R. The loss of a half-space goes like kappa, but for what the boundary keeps out:
// a slab without thickness says how much that is.
double convexity(const Channel& c, double rho) {
  const double outside = lossOf(std::clamp(c.transmittance(0), 0.5, 1.0));
  return std::max(lossOf(std::clamp(rho, 0.0, 1.0)) - lossOf(1 - outside), 0.0) * 2 / c.slowest;
}

// x, y, z of R(h) / rho = x - sqrt(y T(h)^2 + z): Kubelka & Munk 1931, R = a - sqrt(T^2 + a^2 - 1) with
// a = (1 / rho + rho) / 2. T is scaled so that R(0) is what the boundary of a slab without medium sends back,
// T(0) (1 - T(0)) / (1 + T(0)).
glm::vec4 slabReflectance(double thin, double rho) {
  rho = std::clamp(rho, 1e-3, 1.0);
  thin = std::clamp(thin, 0.5, 1.0);
  const double a = 0.5 * (1 / rho + rho), rest = a * a - 1, none = thin * (1 - thin) / (1 + thin);
  const double scale = std::max((a - none) * (a - none) - rest, 0.0) / (thin * thin);
  return {static_cast<float>(a / rho), static_cast<float>(scale / (rho * rho)),
          static_cast<float>(std::max(rest, 0.0) / (rho * rho)), 0};
}

// Burley's d, or that of the same mean radius: 5/2 d = sum w sqrt(pi v / 2). 0: no profile.
double profileLength(const PellucidMaterial& m, int channel) {
  if (m.gaussianCount == 0) return 0;
  if (m.burleyDistance[channel] > 0) return static_cast<double>(m.burleyDistance[channel]);
  double mean = 0, weight = 0;
  for (uint32_t i = 0; i < m.gaussianCount; ++i) {
    const double w = m.gaussianWeight[channel][i];
    mean += w * std::sqrt(kPi / 2 * static_cast<double>(m.gaussianVariance[channel][i]));
    weight += w;
  }
  return weight > 0 ? mean / weight / 2.5 : 0;
}

}  // namespace

shared::GatherConstants gatherConstants(const PellucidMaterial& m) {
  shared::GatherConstants g{};
  std::array<Channel, 3> channels;
  double slowest = INFINITY, fastest = 0;
  for (int c = 0; c < 3; ++c) {
    channels[c] = channelOf(m, c);
    slowest = std::min(slowest, channels[c].slowest);
    fastest = std::max(fastest, channels[c].decay(0));
  }
  // Measured: samples spread between these lengths err least on ears and spheres.
  const double shortest = 1 / fastest, longest = std::max(2.0 / 3 / slowest, shortest);
  const double depthScale = 0.5 / slowest;
  g.lengths = {static_cast<float>(shortest), static_cast<float>(std::log2(longest / shortest)),
               static_cast<float>(2 / slowest), static_cast<float>(depthScale)};
  std::array<glm::vec4, kGatherEntries> slab{}, decay{};
  for (int c = 0; c < 3; ++c) {
    const double d = profileLength(m, c);
    g.profile[c] = static_cast<float>(d > 0 ? 1 / (3 * d) : 0);
    const double more = d > 0 ? convexity(channels[c], static_cast<double>(m.reflectance[c])) : 0;
    g.convexity[c] = static_cast<float>(more);
    g.reflectance[c] = slabReflectance(channels[c].transmittance(0), static_cast<double>(m.reflectance[c]));
    // To both sides: as far as the light comes from.
    g.convexity.w = std::max(g.convexity.w, static_cast<float>(more));
    for (int i = 0; i < kGatherEntries; ++i) {
      // Beyond 500 decay lengths T is below the least double; its logarithm goes on as a line.
      const double v = static_cast<double>(i) / (kGatherEntries - 1), farthest = 500 / channels[c].slowest;
      const double h = v < 1 ? std::min(depthScale * v / (1 - v), farthest) : farthest;
      const double q = channels[c].decay(h);
      slab[i][c] = static_cast<float>((std::log(std::max(channels[c].transmittance(h), 1e-300)) + q * h) /
                                      std::numbers::ln2);
      decay[i][c] = static_cast<float>(q / std::numbers::ln2);
    }
  }
  for (int i = 0; i < kGatherEntries; ++i) {
    const int next = std::min(i + 1, kGatherEntries - 1);
    const glm::vec4 step = slab[next] - slab[i], decayStep = decay[next] - decay[i];
    g.entries[3 * i] = glm::vec4(glm::vec3(slab[i]), step.r);
    g.entries[3 * i + 1] = {step.g, step.b, decay[i].r, decay[i].g};
    g.entries[3 * i + 2] = {decay[i].b, decayStep.r, decayStep.g, decayStep.b};
  }
  // Probes share what they gather as far as the light that comes through thin parts spreads sideways.
  const double reach = longest / 2;
  g.profile.w = static_cast<float>(1 / (reach * reach));
  return g;
}

float gatherReach(const shared::GatherConstants& gather, uint32_t samples) {
  const glm::vec4& lengths = gather.lengths;
  // Entry points lie t + s away, t <= lengths.z along the axis and s the spread of the last sample, which is
  // within the last 1 / samples by at most 25/26 of it (patternOf and gatherSpread of
  // compute/gather/probe_light.glsl and compute/lib/gather.glsl).
  const float rest = 1.0f / (26 * static_cast<float>(samples)), u = 1 - rest;
  return lengths.z - std::log(rest) * lengths.x * std::exp2(lengths.y * u);
}

}  // namespace pellucid
