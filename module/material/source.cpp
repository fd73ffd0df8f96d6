#include "source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "profile.h"

namespace pellucid::material {

struct Source::Solved {
  struct Outer {
    Medium medium;
    Coefficients coefficients;
    double thickness;
  };
  std::vector<Outer> outer;
  Medium core;
  Coefficients coefficients;  // of the core
};

Description rgbDescription(double ior, std::vector<Stack> channels) {
  return {ior, std::move(channels), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

namespace {

bool isHomogeneousRgb(const Description& description) {
  return description.stacks.size() == 3 &&
         std::ranges::all_of(description.stacks, [](const Stack& stack) { return stack.outer.empty(); });
}

}  // namespace

Source::Source(const Description& description)
    : angles_(
          makeAngles(description.ior, isHomogeneousRgb(description) ? AngleCount::Fine : AngleCount::Coarse)),
      weights_(description.weights),
      mixed_(description.stacks.size() != 3) {
  solved_.reserve(description.stacks.size());
  for (const Stack& stack : description.stacks) {
    solved_.push_back({{}, Medium(angles_, stack.core), stack.core});
    for (const Stack::Outer& outer : stack.outer)
      solved_.back().outer.push_back(
          {Medium(angles_, outer.coefficients), outer.coefficients, outer.thickness});
  }
}

Source::~Source() = default;

Slab Source::stackSlab(const Solved& solved, double thickness) const {
  if (solved.outer.empty()) return solved.core.slab(thickness);

  double full = 0;
  for (const auto& outer : solved.outer) full += 2 * outer.thickness;
  const bool slab = std::isfinite(thickness);
  const double share = slab ? -std::expm1(-thickness / full) : 1;  // of each layer's full thickness

  std::vector<Response> responses;
  for (const auto& outer : solved.outer) responses.push_back(outer.medium.layer(outer.thickness * share));
  responses.push_back(solved.core.layer(slab ? thickness - full * share : thickness));
  std::vector<const Response*> order;
  for (const Response& response : responses) order.push_back(&response);
  if (slab)
    for (std::size_t i = solved.outer.size(); i-- > 0;) order.push_back(&responses[i]);
  return layeredSlab(angles_, order);
}

std::array<Slab, 3> Source::slabs(double thickness) const {
  std::array<Slab, 3> rgb = {};
  for (std::size_t s = 0; s < solved_.size(); ++s) {
    const Slab slab = stackSlab(solved_[s], thickness);
    for (std::size_t c = 0; c < 3; ++c) {
      rgb[c].transmittance += weights_[s][c] * slab.transmittance;
      rgb[c].transmittanceNormal += weights_[s][c] * slab.transmittanceNormal;
      rgb[c].reflectance += weights_[s][c] * slab.reflectance;
      rgb[c].reflectanceNormal += weights_[s][c] * slab.reflectanceNormal;
    }
  }
  for (Slab& slab : rgb) {
    slab.transmittance = std::clamp(slab.transmittance, 0.0, 1.0);
    slab.transmittanceNormal = std::clamp(slab.transmittanceNormal, 0.0, 1.0);
    slab.reflectance = std::clamp(slab.reflectance, 0.0, 1.0);
    slab.reflectanceNormal = std::clamp(slab.reflectanceNormal, 0.0, 1.0);
  }
  return rgb;
}

double Source::stackBurleyDistance(const Solved& solved, double rho) const {
  if (solved.outer.empty()) return material::burleyDistance(solved.coefficients, angles_.ior);
  double extinction = 0, reaching = 1;  // e^{-2 kappa z} at the top of the layer
  for (const auto& outer : solved.outer) {
    const double below = reaching * std::exp(-2 * caseEigenvalue(outer.coefficients) * outer.thickness);
    extinction += (reaching - below) * outer.coefficients.extinction();
    reaching = below;
  }
  extinction += reaching * solved.coefficients.extinction();
  const double albedo = equivalentAlbedo(angles_, rho);
  return material::burleyDistance({albedo * extinction, (1 - albedo) * extinction}, angles_.ior);
}

Rgb Source::burleyDistance() const {
  Rgb sum = {}, weight = {};
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t s = 0; s < solved_.size(); ++s) {
    const double rho = stackSlab(solved_[s], std::numeric_limits<double>::infinity()).reflectance;
    const double distance = stackBurleyDistance(solved_[s], rho);
    least = std::min(least, distance);
    most = std::max(most, distance);
    for (std::size_t c = 0; c < 3; ++c) {
      // A medium that only absorbs has no diffused light; its distance must still be defined.
      const double share = weights_[s][c] * std::max(rho, 1e-9);
      sum[c] += share * distance;
      weight[c] += share;
    }
  }
  Rgb mean;
  // Color matching has negative lobes; no mixture reaches beyond its parts.
  for (std::size_t c = 0; c < 3; ++c)
    mean[c] = weight[c] > 0 ? std::clamp(sum[c] / weight[c], least, most) : most;
  return mean;
}

std::optional<double> Source::decay(int channel) const {
  if (mixed_) return std::nullopt;
  return caseEigenvalue(solved_[static_cast<std::size_t>(channel)].coefficients);
}

double Source::extinction(int channel) const {
  double sum = 0, total = 0;
  for (std::size_t s = 0; s < solved_.size(); ++s) {
    const double weight = std::abs(weights_[s][static_cast<std::size_t>(channel)]);
    sum += weight * solved_[s].coefficients.extinction();
    total += weight;
  }
  return sum / total;
}

}  // namespace pellucid::material
