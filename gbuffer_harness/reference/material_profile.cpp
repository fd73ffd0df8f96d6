#include "reference/material_profile.h"

#include <cmath>
#include <numeric>
#include <string>

#include "common/error.h"

namespace pellucid::harness::reference {
namespace {

std::optional<Profile> burley(const PellucidMaterial& m, int channel) {
  const double d = m.burleyDistance[channel];
  if (d == 0) return std::nullopt;
  if (!(d > 0) || !std::isfinite(d))
    throw InputError("", "burleyDistance[" + std::to_string(channel) + "]",
                     std::to_string(d) + " is not a length");
  return BurleyProfile{d};
}

std::optional<Profile> gaussians(const PellucidMaterial& m, int channel) {
  if (m.gaussianCount == 0) return std::nullopt;
  if (m.gaussianCount > PELLUCID_MAX_GAUSSIANS)
    throw InputError("", "gaussianCount", std::to_string(m.gaussianCount) + " is more than a material holds");
  GaussianProfile p;
  for (unsigned i = 0; i < m.gaussianCount; ++i) {
    const double variance = m.gaussianVariance[channel][i], weight = m.gaussianWeight[channel][i];
    if (!(variance > 0) || !std::isfinite(variance) || !std::isfinite(weight))
      throw InputError("", "gaussian " + std::to_string(i),
                       "variance " + std::to_string(variance) + " and weight " + std::to_string(weight) +
                           " (variance > 0, both finite)");
    p.variance.push_back(variance);
    p.weight.push_back(weight);
  }
  const double total = std::accumulate(p.weight.begin(), p.weight.end(), 0.0);
  if (!(total > 0)) throw InputError("", "gaussianWeight", "the weights do not have a positive sum");
  for (double& w : p.weight) w /= total;  // single precision leaves 1e-7
  return p;
}

Profile tabulated(const ProfileValues& table, int channel) {
  std::vector<double> value;
  for (const auto& rgb : table.value) value.push_back(rgb[static_cast<std::size_t>(channel)]);
  return TabulatedProfile(table.radius, value);
}

}  // namespace

std::optional<Profile> channelProfile(const PellucidMaterial& m, int channel, ProfileSource source,
                                      const ProfileValues& table) {
  switch (source) {
    case ProfileSource::Burley:
      return burley(m, channel);
    case ProfileSource::Gaussians:
      return gaussians(m, channel);
    case ProfileSource::Table:
      return tabulated(table, channel);
    default:
      return m.burleyDistance[channel] != 0 ? burley(m, channel) : gaussians(m, channel);
  }
}

}  // namespace pellucid::harness::reference
