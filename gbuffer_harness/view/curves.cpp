#include "view/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pellucid/pellucid_material.h"
#include "reference/material_profile.h"
#include "reference/translucency.h"

namespace pellucid::harness {

namespace {

constexpr double kDarkest = 0.01, kThinnest = 0.1, kThickest = 100, kTail = 0.05;

double brightest(const PellucidMaterial& material, double thickness) {
  double most = 0;
  for (std::uint32_t c = 0; c < 3; ++c)
    most = std::max(most, pellucidEvaluateTransmittance(&material, c, thickness));
  return most;
}

}  // namespace

Curves transmittanceCurves(const PellucidMaterial& material, int points) {
  Curves curves;
  curves.end = kThinnest;
  while (curves.end < kThickest && brightest(material, curves.end) > kDarkest) curves.end *= 1.1;
  for (std::uint32_t c = 0; c < 3; ++c)
    for (int i = 0; i < points; ++i)
      curves.values[c].push_back(pellucidEvaluateTransmittance(&material, c, curves.end * i / (points - 1)));
  return curves;
}

Curves angleCurve(const TranslucencySettings& settings, int points) {
  Curves curves;
  curves.end = 90;
  const PellucidAngleModel model = settings.angleModel;
  if (model == PELLUCID_ANGLE_NORMAL || model > PELLUCID_ANGLE_MINIMUM_DOT) return curves;
  for (int i = 0; i < points; ++i) {
    const double x = std::sin(std::numbers::pi / 2 * i / (points - 1));
    curves.values[0].push_back(reference::angleFactor(settings, x, double(settings.minimumDot)));
  }
  return curves;
}

Curves profileCurves(const PellucidMaterial& material, int points) {
  Curves curves;
  std::array<std::optional<reference::Profile>, 3> profiles;
  double end = 0;
  for (int c = 0; c < 3; ++c) {
    std::optional<reference::Profile>& profile = profiles[static_cast<std::size_t>(c)];
    profile = reference::channelProfile(material, c, reference::ProfileSource::Material, {});
    if (profile) end = std::max(end, reference::radiusOfTail(*profile, kTail));
  }
  if (end > 0) curves.end = end;
  for (std::size_t c = 0; c < 3; ++c)
    for (int i = 0; profiles[c] && i < points; ++i)
      curves.values[c].push_back(reference::ringDensity(*profiles[c], curves.end * i / (points - 1)));
  return curves;
}

}  // namespace pellucid::harness
