#include "reference/gather_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/error.h"
#include "reference/transmittance.h"

namespace pellucid::harness::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kTable = 4096;

// Burley's d of the same mean radius, 5/2 d, where a material has Gaussians only: w sqrt(pi v / 2) each.
double profileLength(const PellucidMaterial& m, int channel) {
  if (m.gaussianCount == 0) return 0;
  if (m.burleyDistance[channel] > 0) return m.burleyDistance[channel];
  double mean = 0, weight = 0;
  for (unsigned i = 0; i < m.gaussianCount; ++i) {
    const double w = m.gaussianWeight[channel][i];
    mean += w * std::sqrt(kPi / 2 * m.gaussianVariance[channel][i]);
    weight += w;
  }
  return mean / weight / 2.5;
}

}  // namespace

GatherPath gatherPath(const glm::dvec3& to, const glm::dvec3& exitNormal, const glm::dvec3& entryNormal) {
  const double distance = glm::length(to);
  const double facing = 0.5 + 0.5 * std::clamp(glm::dot(exitNormal, entryNormal), -1.0, 1.0);
  const double out = std::max(0.0, glm::dot(exitNormal, to)), in = std::max(0.0, -glm::dot(entryNormal, to));
  const double square = facing < 1 ? out * in / (1 - facing) : 0;
  return {distance, std::min(distance, std::sqrt(square)), facing};
}

GatherKernel::GatherKernel(const PellucidMaterial& material) : material_(material) {
  const bool sinhExp = material.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP;
  if (!sinhExp && material.transmittanceModel != PELLUCID_TRANSMITTANCE_EXP2)
    throw InputError("", "transmittanceModel",
                     std::to_string(material.transmittanceModel) + " has no gather kernel");
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const float* p = material.transmittance[c];
    profile_[i] = profileLength(material, c);
    if (sinhExp) {
      slowest_[i] = p[1];
      extrapolation_[i] = double(p[2]) / double(p[1]);
      continue;
    }
    // In a slab T goes like 1 / sinh(kappa (d + e)), whose rate kappa coth(kappa (d + e)) at half depth
    // gives e; one exponential has none.
    slowest_[i] = INFINITY;
    for (const int term : {0, 2})
      if (p[term] > 0) slowest_[i] = std::min(slowest_[i], double(p[term + 1]));
    double low = 0, high = 100 / slowest_[i];
    for (int step = 0; step < 100; ++step) {
      const double middle = 0.5 * (low + high);
      (transmittance(c, middle) > 0.5 * transmittance(c, 0) ? low : high) = middle;
    }
    const double a1 = p[0] * std::exp(-p[1] * low), a2 = p[2] * std::exp(-p[3] * low);
    const double rate = (a1 * double(p[1]) + a2 * double(p[3])) / (a1 + a2);
    const double excess = rate / slowest_[i] - 1;
    extrapolation_[i] =
        excess > 1e-6 ? std::max(0.5 * std::log((2 + excess) / excess) / slowest_[i] - low, 0.0) : INFINITY;
  }
  longest_ = radius(1e-9);
  table_.resize(kTable);
  for (std::size_t i = 0; i < kTable; ++i) {
    const double depth = longest_ * std::pow(static_cast<double>(i) / (kTable - 1), 2);
    for (int c = 0; c < 3; ++c) {
      table_[i].decay[c] = decay(c, depth);
      table_[i].weight[c] = transmittance(c, depth) * table_[i].decay[c] / (2 * kPi);
    }
  }
}

double GatherKernel::transmittance(int channel, double depth) const {
  return reference::transmittance(material_, depth)[channel];
}

double GatherKernel::decay(int channel, double depth) const {
  const auto i = static_cast<std::size_t>(channel);
  // The floor keeps a slab without thickness and extrapolation finite.
  return std::hypot(slowest_[i], kPi / std::max(depth + extrapolation_[i], 1e-3));
}

glm::dvec3 GatherKernel::transmitted(double distance, double depth) const {
  const double at = std::sqrt(std::min(depth / longest_, 1.0)) * (kTable - 1);
  const auto cell = std::min(static_cast<std::size_t>(at), kTable - 2);
  const double f = at - static_cast<double>(cell);
  const Slab &a = table_[cell], &b = table_[cell + 1];
  const glm::dvec3 weight = a.weight + f * (b.weight - a.weight);
  const glm::dvec3 decay = a.decay + f * (b.decay - a.decay);
  return weight * glm::exp((depth - distance) * decay) / distance;
}

glm::dvec3 GatherKernel::reflected(double r) const {
  glm::dvec3 result(0);
  for (int c = 0; c < 3; ++c) {
    const double d = profile_[static_cast<std::size_t>(c)];
    if (!(d > 0)) continue;
    const double e = std::exp(-r / (3 * d));
    result[c] = (e * e * e + e) / (8 * kPi * d * r);
  }
  return result;
}

glm::dvec3 GatherKernel::reflectedWithin(double r) const {
  glm::dvec3 result(0);
  for (int c = 0; c < 3; ++c) {
    const double d = profile_[static_cast<std::size_t>(c)];
    if (d > 0) result[c] = 1 - 0.25 * std::exp(-r / d) - 0.75 * std::exp(-r / (3 * d));
  }
  return result;
}

glm::dvec3 GatherKernel::reflectance() const {
  return {material_.reflectance[0], material_.reflectance[1], material_.reflectance[2]};
}

glm::dvec3 GatherKernel::slabReflectance(double depth) const {
  glm::dvec3 result(1);
  for (int c = 0; c < 3; ++c) {
    const double rho = std::clamp(double(material_.reflectance[c]), 1e-3, 1.0);
    const double thin = std::clamp(transmittance(c, 0), 0.5, 1.0), t = transmittance(c, depth);
    const double a = 0.5 * (1 / rho + rho), rest = std::max(a * a - 1, 0.0);
    const double boundary = thin * (1 - thin) / (1 + thin);  // T(0) F of T(0) = (1 - F) / (1 + F)
    const double scale = std::max(std::pow(a - boundary, 2) - rest, 0.0) / (thin * thin);
    result[c] = std::clamp((a - std::sqrt(scale * t * t + rest)) / rho, 0.0, 1.0);
  }
  return result;
}

GatherKernel::Diffusion GatherKernel::diffusion(int c) const {
  const auto i = static_cast<std::size_t>(c);
  Diffusion d{};
  d.rho = std::clamp(double(material_.reflectance[c]), 1e-3, 1.0);
  // The boundary keeps out .6 (1 - T(0)) of light from all around, within .4 % for indices up to 1.5.
  d.entering = 0.4 + 0.6 * std::clamp(transmittance(c, 0), 0.5, 1.0);
  d.beyond = std::min(extrapolation_[i] / 2, 10 / slowest_[i]);
  // rho = entering e^{-k (source + beyond)} cosh(k beyond) / cosh(k source), solved for e^{2 k source}
  const double square = d.entering * (1 + std::exp(-2 * slowest_[i] * d.beyond)) / d.rho - 1;
  d.source = square > 1 ? std::log(square) / (2 * slowest_[i]) : 0;
  return d;
}

// A source on the shell R - source, and density 0 on the shell R + beyond: the flux through the shell R.
double GatherKernel::leaves(int c, int order, double radius) const {
  const Diffusion d = diffusion(c);
  const double k = slowest_[static_cast<std::size_t>(c)];
  const double from = k * std::max(radius - d.source, 1e-3 * radius), at = k * radius,
               end = k * (radius + d.beyond);
  // Solutions of the modified spherical Bessel equation and their derivatives.
  const auto rising = [&](double y) {
    const double zero = std::sinh(y) / y;
    if (order == 0) return zero;
    return y < 1e-2 ? y / 3 : (std::cosh(y) - zero) / y;
  };
  const auto falling = [&](double y) { return std::exp(-y) / y * (order == 0 ? 1 : 1 + 1 / y); };
  const auto steps = [&](const auto& f, double y) {  // derivative: f is analytic, so that h^4 is its error
    const double h = 1e-3 * y;
    return (8 * (f(y + h) - f(y - h)) - (f(y + 2 * h) - f(y - 2 * h))) / (12 * h);
  };
  const double slope = steps(rising, at) * falling(end) / rising(end) - steps(falling, at);
  return d.entering / std::cosh(k * d.source) * at * at * rising(from) * slope;
}

glm::dvec3 GatherKernel::leavesBall(double radius) const {
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c) {
    const Diffusion d = diffusion(c);
    const double inside = 1 - d.entering / (15 - 14 * d.entering);  // reflected at the boundary from inside
    const double open = d.rho / (d.entering + (d.rho - d.entering) * inside);
    const double loss = open < 1 ? (1 - open) / (1 + open) : 0;
    const double more = (1 - loss * loss * inside) * (leaves(c, 0, radius) - d.rho);
    result[c] = d.rho + std::clamp(more, 0.0, std::max(d.entering - d.rho, 0.0));
  }
  return result;
}

glm::dvec3 GatherKernel::ball(int c, double radius) const {
  const auto i = static_cast<std::size_t>(c);
  const double rho = diffusion(c).rho, length = profile_[i], all = leavesBall(radius)[c] / rho;
  const double dark =
      std::max(all * std::clamp(1 - leaves(c, 1, radius) / leaves(c, 0, radius), 0.0, 1.0), 1e-6);
  // Over the ball, dA = 2 pi r dr by the chord's length r; w = (r / 2R)^2 is 1 - m.
  double through = 0, throughDark = 0, enteringDark = 0, opposite = 0;
  constexpr int kSteps = 500;
  const double step = std::min(2 * radius, 40 / slowest_[i]) / kSteps;
  for (int n = 0; n < kSteps; ++n) {
    const double r = (n + 0.5) * step, w = r * r / (4 * radius * radius);
    const double comes = transmittance(c, r) * decay(c, r) / rho * step;
    const double returns = (std::exp(-r / length) + std::exp(-r / (3 * length))) / (4 * length) * step;
    through += w * comes;
    throughDark += 2 * w * w * comes;
    enteringDark += 2 * w * (1 - w) * returns;
    if (r < 0.7 * radius) opposite += w * returns;
  }
  const double returned = all + opposite - through;
  const double off = 1 - (returned * enteringDark + throughDark) / dark;
  const double change = (throughDark - enteringDark * through) / dark;
  const double less = std::clamp(-off * change / (change * change + 0.05), 0.0, 0.5);
  return {returned - slabReflectance(2 * radius)[c], -less, less * through};
}

BodyFactors GatherKernel::body(double thickness, double curvature) const {
  BodyFactors factors;
  if (thickness < INFINITY) factors.returned = slabReflectance(thickness);
  if (curvature == 0) return factors;
  const double diameters = thickness * curvature / 2;
  const double round = diameters > 0 ? std::min(diameters, 1 / diameters) : 0;
  const double most = std::max(0.1, std::pow(round, 4));
  for (int c = 0; c < 3; ++c) {
    if (!(profile_[static_cast<std::size_t>(c)] > 0)) continue;
    const glm::dvec3 more =
        ball(c, std::min(1 / std::abs(curvature), 200 / slowest_[static_cast<std::size_t>(c)]));
    factors.returned[c] +=
        curvature < 0 ? -std::clamp(more[0], 0.0, 0.1) : std::min(more[0] + round * more[2], most);
    factors.through[c] += round * more[1];
  }
  return factors;
}

double GatherKernel::bodyReach() const {
  double reach = 0;
  for (int c = 0; c < 3; ++c)
    if (profile_[static_cast<std::size_t>(c)] > 0)
      reach = std::max(reach, diffusion(c).source + diffusion(c).beyond);
  return reach;
}

double GatherKernel::radius(double share) const {
  double radius = 0;
  for (int c = 0; c < 3; ++c) {
    double low = 0, high = -std::log(share) / slowest_[static_cast<std::size_t>(c)];
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (transmittance(c, middle) > share * transmittance(c, 0) ? low : high) = middle;
    }
    radius = std::max({radius, high, -3 * std::log(share) * profile_[static_cast<std::size_t>(c)]});
  }
  return radius;
}

}  // namespace pellucid::harness::reference
