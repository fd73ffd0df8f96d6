// A material's constants for the light-space gather (docs/how-it-works.md). Pure.
#include "material/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/packing.hpp>
#include <numbers>

#include "material/transmittance.h"

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
  const double slow = !exp2 || !(p(2) > 0) ? p(1) : p(0) > 0 ? std::min(p(1), p(3)) : p(3);  // of terms that there are
  c.slowest = std::max(slow, 1e-6);
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

// Parts of the light on a ball that leave it.
struct Leaves {
  double all;   // of light from all around
  double dark;  // four times what leaves the dark half per area, of light from one side
};

// Diffusion in a ball, as fitted to a channel's T and rho: light starts to diffuse at the depth `source`, and
// its density falls to 0 at the distance `beyond` outside the surface.
struct Diffusion {
  double kappa, source, beyond;
  double entering;  // part of light from all around that the boundary lets in
  double rho;
  double excess;  // part that walks show of what a ball returns beyond rho

  Leaves ball(double radius) const {
    const double x = kappa * radius, from = kappa * std::max(radius - source, 1e-3 * radius),
                 outer = x + kappa * beyond;
    // Modified spherical Bessel functions.
    const auto i0 = [](double y) { return std::sinh(y) / y; };
    const auto i1 = [&](double y) { return y > 1e-2 ? (std::cosh(y) - i0(y)) / y : y / 3; };
    const auto k0 = [](double y) { return std::exp(-y) / y; };
    const auto k1 = [&](double y) { return k0(y) * (1 + 1 / y); };
    // What leaves, by order of the spherical harmonic of the irradiance.
    const double factor = entering / std::cosh(kappa * source) * x * x;
    const double order0 = factor * i0(from) * (k1(x) + i1(x) * k0(outer) / i0(outer));
    const double order1 =
        factor * i1(from) * (k0(x) + 2 / x * k1(x) + (i0(x) - 2 / x * i1(x)) * k1(outer) / i1(outer));
    // A convex body returns more than a half-space, and no more than what enters.
    const double all = std::clamp(rho + excess * (order0 - rho), rho, std::max(entering, rho));
    // Light from one side has the order 1 and even ones, of which only the order 0 has a mean over half a
    // ball.
    return {all, all * std::clamp(1 - order1 / order0, 0.0, 1.0)};
  }
};

// Part of the light that a boundary turns back from all around, of the light that a slab without thickness
// turns back. Measured: Fresnel's integrals for indices up to 1.5, within .4 %.
constexpr double kTurnedBack = 0.6;
// Slope of n^2 over that part. Measured: Fresnel's integrals for indices up to 1.5, within 4 %.
constexpr double kSquaredIndex = 14;

Diffusion diffusionOf(const Channel& c, double rho) {
  // A slab's T goes like 1 / sinh(kappa (d + 2 beyond)).
  Diffusion d{c.slowest, 0, std::min(c.extrapolation / 2, 10 / c.slowest), 0, rho, 1};
  d.entering = 1 - kTurnedBack * (1 - std::clamp(c.transmittance(0), 0.5, 1.0));
  // A half-space returns entering / cosh(kappa source) e^{-kappa (source + beyond)} cosh(kappa beyond).
  const double inside = 2 * rho / (1 + std::exp(-2 * d.kappa * d.beyond));
  d.source = std::log(std::max(2 * d.entering / inside - 1, 1.0)) / (2 * d.kappa);
  // Diffusion theory has too much where absorption is strong and the boundary reflects inside: by the square
  // of b = (1 - r) / (1 + r), r being the half-space's reflectance without a boundary. With this power, walks
  // in balls of skin of 2 to 12 mm with index 1.4 agree within 4 %.
  const double reflected = 1 - d.entering / (1 + kSquaredIndex * (1 - d.entering));
  const double r = rho / (d.entering * (1 - reflected) + rho * reflected), b = std::max(1 - r, 0.0) / (1 + r);
  d.excess = 1 - b * b * reflected;
  return d;
}

// What a kernel of the chord's length r adds up to over a ball, up to `longest`: chords end on 2 pi r dr of
// its surface. `density`: of r and of 1 - m = (r / 2 R)^2.
template <class Density>
double overBall(double radius, double longest, const Density& density) {
  constexpr int kSteps = 128;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = longest * (i + 0.5) / kSteps, across = r / (2 * radius);
    sum += density(r, across * across);
  }
  return sum * longest / kSteps;
}

// How far seen points count as opposite, of the radius. Measured: procedural balls of marble, the bunny of
// marble.
constexpr double kMostOpposite = 0.7;

// Weight of a change of what comes through, beside the dark half's error. Measured: procedural balls and
// rings of marble.
constexpr double kHeld = 0.05;

// Most that a ball takes of what comes through. Measured: procedural sheets of wax.
constexpr double kMostLess = 0.5;

// Factors of a ball's diffused irradiance, and of what comes through it.
struct BallFactors {
  double returned;  // all that the gather adds up is what leaves the ball
  double through;   // and what leaves its dark half is right, too: at most 1
  double instead;   // more of `returned`, for what comes through no more
};

BallFactors ballFactors(const Channel& c, const Diffusion& diffusion, double profile, double radius) {
  const double rho = diffusion.rho, longest = std::min(2 * radius, 20 / c.slowest),
               reach = std::min(2 * radius, 30 * profile);
  const auto comes = [&](double r) { return c.transmittance(r) * c.decay(r) / rho; };
  const auto reflected = [&](double r) {
    const double e = std::exp(-r / (3 * profile));
    return (e * e * e + e) / (4 * profile);
  };
  // Of a kernel K the dark half gets the part 2 (1 - m) K.
  const double through = overBall(radius, longest, [&](double r, double w) { return w * comes(r); });
  const double throughDark =
      overBall(radius, longest, [&](double r, double w) { return 2 * w * w * comes(r); });
  const double enteringDark =
      overBall(radius, reach, [&](double r, double w) { return 2 * w * (1 - w) * reflected(r); });
  // What `opposite` takes, up to where what enters hidden makes up for it.
  const double opposite = overBall(radius, std::min(kMostOpposite * radius, reach),
                                   [&](double r, double w) { return w * reflected(r); });
  const Leaves leaves = diffusion.ball(radius);
  const double returned = leaves.all / rho + opposite - through;
  // Least squares of the dark half's error and of the change. Factors above 1 are right for balls, and make
  // rims of ears and rings too bright.
  const double dark = std::max(leaves.dark / rho, 1e-6);
  const double off = 1 - (returned * enteringDark + throughDark) / dark,
               change = (throughDark - enteringDark * through) / dark;
  const double less = std::clamp(-off * change / (change * change + kHeld), 0.0, kMostLess);
  return {returned, 1 - less, less * through};
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

// R(h) / rho
double slabReturns(const Channel& c, const glm::vec4& reflectance, double h) {
  const double t = c.transmittance(h), x = reflectance.x, y = reflectance.y, z = reflectance.z;
  return std::clamp(x - std::sqrt(y * t * t + z), 0.0, 1.0);
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

// Longest mean distance of samples, of diffusion lengths. Measured: procedural balls of skin, rings of
// marble.
constexpr double kLongest = 2.0 / 3;
// Least decay of the longest sample and of the entries' scale, as a part of the fastest decay. White media decay over kilometers: without
// this limit, samples and entries would lie outside all bodies.
constexpr double kLeastDecay = 0.005;

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
  // Samples spread between these lengths.
  const double slow = std::max(slowest, kLeastDecay * fastest);
  const double shortest = 1 / fastest, longest = std::max(kLongest / slow, shortest);
  // Half of the entries are of the thicknesses up to this one, where T changes fastest.
  const double depthScale = 0.5 / slow;
  g.lengths = {static_cast<float>(shortest), static_cast<float>(std::log2(longest / shortest)),
               static_cast<float>(2 / slowest), static_cast<float>(depthScale)};
  std::array<glm::vec4, kGatherEntries> slab{}, decay{};
  std::array<std::array<float, 6>, kGatherEntries> balls{};
  std::array<glm::vec4, kGatherEntries> instead{};
  for (int c = 0; c < 3; ++c) {
    const double d = profileLength(m, c);
    g.profile[c] = static_cast<float>(d > 0 ? 1 / (3 * d) : 0);
    const double rho = std::clamp(static_cast<double>(m.reflectance[c]), 1e-3, 1.0);
    const Diffusion diffusion = diffusionOf(channels[c], rho);
    g.reflectance[c] = slabReflectance(channels[c].transmittance(0), static_cast<double>(m.reflectance[c]));
    // To both sides: as far as the light comes from.
    if (d > 0) g.body.x = std::max(g.body.x, static_cast<float>(diffusion.source + diffusion.beyond));
    for (int i = 0; i < kGatherEntries; ++i) {
      // Beyond 500 decay lengths T is below the least double; its logarithm goes on as a line.
      const double v = static_cast<double>(i) / (kGatherEntries - 1), farthest = 500 / channels[c].slowest;
      const double h = v < 1 ? std::min(depthScale * v / (1 - v), farthest) : farthest;
      const double q = channels[c].decay(h);
      slab[i][c] = static_cast<float>((std::log(std::max(channels[c].transmittance(h), 1e-300)) + q * h) /
                                      std::numbers::ln2);
      decay[i][c] = static_cast<float>(q / std::numbers::ln2);
      if (!(d > 0) || i + 1 == kGatherEntries) continue;  // the last one is a plane
      const BallFactors ball = ballFactors(channels[c], diffusion, d, std::max(h / 2, 1e-3));
      balls[i][c] = static_cast<float>(ball.returned - slabReturns(channels[c], g.reflectance[c], h));
      balls[i][3 + c] = static_cast<float>(ball.through - 1);
      instead[i][c] = static_cast<float>(ball.instead);
    }
  }
  for (int i = 0; i < kGatherEntries; ++i) {
    const int next = std::min(i + 1, kGatherEntries - 1);
    const glm::vec4 step = slab[next] - slab[i], decayStep = decay[next] - decay[i];
    g.entries[3 * i] = glm::vec4(glm::vec3(slab[i]), step.r);
    g.entries[3 * i + 1] = {step.g, step.b, decay[i].r, decay[i].g};
    g.entries[3 * i + 2] = {decay[i].b, decayStep.r, decayStep.g, decayStep.b};
    const auto halves = [&](int k) { return glm::packHalf2x16({balls[i][k], balls[i][k + 1]}); };
    g.ball[i] = {halves(0), halves(2), halves(4), glm::packUnorm4x8(instead[i])};
  }
  // Probes share what they gather as far as the light that comes through thin parts spreads sideways.
  const double reach = longest / 2;
  g.profile.w = static_cast<float>(1 / (reach * reach));
  return g;
}

float gatherReach(const shared::GatherConstants& gather, uint32_t samples) {
  const glm::vec4& lengths = gather.lengths;
  // Entry points lie t + s away, t <= lengths.z along the axis and s the spread of the last sample, which is
  // within the last 1 / samples, half a pattern's share before its end at most (patternOf and gatherSpread of
  // compute/gather/probe_light.glsl).
  const float rest = 0.5f / (PELLUCID_PATTERNS * static_cast<float>(samples)), u = 1 - rest;
  return lengths.z - std::log(rest) * lengths.x * std::exp2(lengths.y * u);
}

}  // namespace pellucid
