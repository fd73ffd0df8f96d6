#include "reference/translucency.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "common/error.h"
#include "reference/transmittance.h"

namespace pellucid::harness::reference {

namespace {

template <class T>
glm::dvec3 vec(const std::array<T, 3>& a) {
  return {double(a[0]), double(a[1]), double(a[2])};
}

// Weighs the two entries on either side of the light's angle about the up axis.
double byAzimuth(const std::vector<float>& table, double sideways, double ahead) {
  const double step = 360.0 / double(table.size());
  double degrees = std::atan2(sideways, ahead) * 180 / std::numbers::pi;
  if (degrees < 0) degrees += 360;
  double sum = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    double apart = std::abs(degrees - double(i) * step);
    apart = std::min(apart, 360 - apart);
    sum += double(table[i]) * std::max(0.0, 1 - apart / step);
  }
  return table.size() == 1 ? double(table[0]) : sum;
}

// Tent weights of all entries at the direction's place on the unfolded octahedron.
double bySphere(const std::vector<float>& table, const glm::dvec3& local) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(table.size()))));
  const double length = std::abs(local.x) + std::abs(local.y) + std::abs(local.z);
  double x = length > 0 ? local.x / length : 0, y = length > 0 ? local.z / length : 0;
  if (local.y < 0) {
    const double foldedX = (x < 0 ? -1 : 1) * (1 - std::abs(y));
    y = (y < 0 ? -1 : 1) * (1 - std::abs(x));
    x = foldedX;
  }
  const double spacing = 2.0 / double(side - 1);
  double sum = 0;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i)
      sum += double(table[j * side + i]) *
             std::max(0.0, 1 - std::abs(x - (double(i) * spacing - 1)) / spacing) *
             std::max(0.0, 1 - std::abs(y - (double(j) * spacing - 1)) / spacing);
  return sum;
}

}  // namespace

double minimumDot(const TranslucencySettings& s, const Light& light) {
  if (!s.hasMinimumDotTable()) return double(s.minimumDot);
  const bool azimuth = s.angleModel == kMinimumDotAzimuth;
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(s.minimumDotTable.size()))));
  if (s.minimumDotTable.empty() || (!azimuth && (side < 3 || side * side != s.minimumDotTable.size())))
    throw InputError("", "minimumDotTable",
                     std::to_string(s.minimumDotTable.size()) + " entries do not fit the angle model");
  for (const float m : s.minimumDotTable)
    if (!(m >= -1 && m <= 0)) throw InputError("", "minimumDotTable", "holds " + std::to_string(m) + ", outside [-1, 0]");
  glm::dvec3 toLight = light.type == PELLUCID_LIGHT_DIRECTIONAL ? -vec(light.direction)
                                                                : vec(light.position) - vec(s.objectCenter);
  if (glm::length(toLight) > 0) toLight = glm::normalize(toLight);
  const glm::dvec3 up = glm::normalize(vec(s.upAxis));
  const glm::dvec3 across = glm::cross(up, glm::normalize(vec(s.faceVector)));
  // Nearer to each other than this, float rounding would decide where the face looks.
  if (!(glm::length(across) > 1e-4))
    throw InputError("", "faceVector and upAxis", "must be finite, longer than 0 and not parallel");
  const glm::dvec3 sideways = glm::normalize(across);
  const glm::dvec3 ahead = glm::cross(sideways, up);
  const glm::dvec3 local(glm::dot(toLight, sideways), glm::dot(toLight, up), glm::dot(toLight, ahead));
  return azimuth ? byAzimuth(s.minimumDotTable, local.x, local.z) : bySphere(s.minimumDotTable, local);
}

Translucency::Translucency(const Capture& capture, const SurfaceReader& surfaces,
                           const TranslucencySettings& settings)
    : capture_(capture), surfaces_(surfaces), settings_(settings) {
  for (const Light& light : capture.lights) {
    shadows_.emplace_back();
    for (const ShadowMap& map : light.shadowMaps) shadows_.back().emplace_back(light, map);
    minimumDots_.push_back(minimumDot(settings_, light));
  }
}

Translucency::Receiver Translucency::toWorld(const Surface& s, const PellucidMaterial& material,
                                             int index) const {
  const glm::dmat4& m = surfaces_.worldFromView();
  const glm::dmat3 rotation(m);
  return {glm::dvec3(m * glm::dvec4(s.position, 1)),
          rotation * s.ray,
          rotation * surfaces_.facet(s),
          s.chord,
          index,
          &material,
          &s};
}

double angleFactor(const TranslucencySettings& settings, double x, double minimumDot) {
  const auto& c = settings.anglePolynomial;
  const double m = minimumDot;
  if (settings.prescaleAngle && settings.angleModel >= PELLUCID_ANGLE_COSINE &&
      settings.angleModel <= PELLUCID_ANGLE_POLYNOMIAL) {
    const double begin = double(settings.minimumDot);
    if (!(begin > -1)) return 0;
    x = (begin + x) / (begin + 1);
    if (x <= 0) return 0;
  }
  switch (settings.moduleModel()) {
    case PELLUCID_ANGLE_INVERSE_COSINE:
      return std::max(0.0, 1 - std::acos(x) * 2 / std::numbers::pi);
    case PELLUCID_ANGLE_POLYNOMIAL: {
      const double angle = std::numbers::pi - std::acos(x);
      const double value =
          double(c[0]) + angle * (double(c[1]) + angle * (double(c[2]) + angle * double(c[3])));
      return x > 0 ? std::clamp(value, 0.0, 1.0) : 0.0;
    }
    case PELLUCID_ANGLE_MINIMUM_DOT:
      return m > -1 ? std::clamp((m + x) / (m + 1), 0.0, 1.0) : 0.0;
    default:
      return std::max(0.0, x);
  }
}

double Translucency::hiddenCosine(const Receiver& r, std::size_t light, const glm::dvec3& toLight) const {
  if (settings_.angleModel == PELLUCID_ANGLE_NORMAL) return std::max(0.0, -glm::dot(r.normal, toLight));
  const glm::dvec3 axis = glm::normalize(glm::dmat3(surfaces_.worldFromView()) * glm::dvec3(0, 0, -1));
  const double x = std::clamp(glm::dot(settings_.constantViewDirection ? axis : r.ray, toLight), -1.0, 1.0);
  return angleFactor(settings_, x, minimumDots_[light]);
}

bool Translucency::usesLightSpace(std::size_t light) const {
  return !shadows_[light].empty() && !settings_.cameraThickness && !holdsBackFaces(capture_.lights[light]);
}

std::optional<Translucency::Taps> Translucency::texelsAround(std::size_t light,
                                                             const glm::dvec3& point) const {
  const ShadowView* map = ShadowView::find(shadows_[light], point);
  return map ? map->around(point) : std::nullopt;
}

// A receiver of the exit surface lies off the depth of its own texel by the slope there; half the diagonal of
// a texel and curvature are one texel each. The light grazes where that would be more than 8 texels.
double Translucency::ownTolerance(const ShadowView::Lookup& lookup, double cosine) {
  constexpr double kMostTexels = 8;
  cosine = std::abs(cosine);
  const double slope = cosine > 0 ? std::tan(std::acos(std::min(cosine, 1.0))) : kMostTexels;
  return lookup.texel * std::min(1 + slope, kMostTexels);
}

bool Translucency::entersMedium(const ShadowView::Lookup& lookup, const Receiver& r) {
  return lookup.kind == ShadowView::Kind::Surface &&
         (!lookup.casterMaterial || *lookup.casterMaterial == r.material);
}

bool Translucency::beyondExit(const ShadowView::Lookup& lookup, const Receiver& r,
                              const glm::dvec3& toLight) {
  return lookup.fromExit &&
         *lookup.fromExit > ownTolerance(lookup, glm::dot(r.normal, toLight)) + lookup.exitUncertain;
}

// None where the texel stores the receiver itself, which a face that turns away from the light is not, and
// none through what is opaque.
double Translucency::comesThrough(const ShadowView::Lookup& lookup, const Receiver& r,
                                  const glm::dvec3& toLight) const {
  constexpr double kTurned = 0.5;
  const double facing = glm::dot(r.normal, toLight);
  if (lookup.clamped || !entersMedium(lookup, r) || beyondExit(lookup, r, toLight)) return 0;
  if (isOpaque(*r.medium, std::max(0.0, lookup.distance * surfaces_.millimetersPerUnit()))) return 0;
  const double tolerance =
      (ownTolerance(lookup, facing) + lookup.uncertain) * std::clamp(1 + facing / kTurned, 0.0, 1.0);
  return tolerance > 0 ? std::clamp(lookup.distance / tolerance - 1, 0.0, 1.0) : 1;
}

// As an exponential has it that halves at the same depth as T.
double Translucency::meanThickness(const Taps& taps, const std::array<double, 4>& weights,
                                   const Receiver& r) const {
  const double half = halfThickness(*r.medium) / surfaces_.millimetersPerUnit();
  double total = 0, sum = 0;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (weights[i] <= 0) continue;
    total += weights[i];
    sum += weights[i] * std::exp2(-std::max(0.0, taps[i].found.distance) / half);
  }
  return -std::log2(sum / total) * half;
}

Translucency::LightPath Translucency::lightSpacePath(std::size_t light, const Receiver& r) const {
  const Arrival arrival = arrivalAt(capture_.lights[light], r.position);
  LightPath path;
  path.arriving = arrival.irradiance * hiddenCosine(r, light, arrival.toLight);
  const std::optional<Taps> taps = texelsAround(light, r.position);
  if (!taps) return path;
  std::array<double, 4> weights;
  for (std::size_t i = 0; i < taps->size(); ++i) {
    weights[i] = (*taps)[i].weight * comesThrough((*taps)[i].found, r, arrival.toLight);
    path.reaches += weights[i];
  }
  if (path.reaches > 0) path.thickness = meanThickness(*taps, weights, r);
  return path;
}

double Translucency::litPart(std::size_t light, const Receiver& r, const glm::dvec3& backPoint, double facing) const {
  if (shadows_[light].empty()) return 1;
  const std::optional<Taps> taps = texelsAround(light, backPoint);
  if (!taps) return 0;
  double lit = 0;
  for (const auto& [weight, found] : *taps) {
    if (!entersMedium(found, r)) continue;
    const double tolerance = ownTolerance(found, facing) + found.uncertain;
    // A face that light leaves by is not one that it enters by.
    const double most = holdsBackFaces(capture_.lights[light]) ? 0 : 2;
    lit += weight * std::clamp(most - found.distance / tolerance, 0.0, 1.0);
  }
  return lit;
}

Translucency::LightPath Translucency::cameraSpacePath(std::size_t light, const Receiver& r) const {
  LightPath path;
  if (!r.chord) return path;
  const SurfaceReader::HiddenFace face = surfaces_.hiddenFace(*r.surface);
  const glm::dmat4& world = surfaces_.worldFromView();
  const glm::dvec3 backPoint = glm::dvec3(world * glm::dvec4(face.position, 1));
  const Arrival arrival = arrivalAt(capture_.lights[light], backPoint);
  const double facing = glm::dot(glm::dmat3(world) * face.normal, arrival.toLight);
  const bool byNormal = settings_.angleModel == PELLUCID_ANGLE_NORMAL;
  path.arriving = arrival.irradiance * (byNormal ? std::max(facing, 0.0) : hiddenCosine(r, light, arrival.toLight));
  path.reaches = litPart(light, r, backPoint, facing);
  if (byNormal) path.opposite = face.opposite;
  path.thickness = settings_.chordThickness ? *r.chord : face.thickness;
  return path;
}

// The texels of a plane that is tilted by this cosine lie off their depths by the diagonal of a texel times
// its slope; where the light grazes, 32 texels have to do.
double Translucency::unblockedPart(std::size_t light, const Receiver& r, double facing) const {
  constexpr double kMostTexels = 32;
  if (shadows_[light].empty()) return 1;
  const std::optional<Taps> taps = texelsAround(light, r.position);
  if (!taps) return 0;
  const double slope = std::sqrt(1 - std::min(facing * facing, 1.0)) / std::max(std::abs(facing), 1e-3);
  double blocked = 0;
  for (const auto& [weight, found] : *taps) {
    if (found.kind != ShadowView::Kind::Surface) continue;
    const double tolerance =
        found.texel * std::min(1 + std::numbers::sqrt2 * slope, kMostTexels) + found.uncertain;
    blocked += weight * std::clamp(found.distance / tolerance - 1, 0.0, 1.0);
  }
  return 1 - blocked;
}

Translucency::LightPath Translucency::thinWallPath(std::size_t light, const Receiver& r) const {
  constexpr double kTurned = 0.1;
  const Arrival arrival = arrivalAt(capture_.lights[light], r.position);
  const double turn = glm::dot(r.normal, arrival.toLight);
  LightPath path;
  path.arriving = arrival.irradiance * hiddenCosine(r, light, arrival.toLight);
  path.reaches = std::clamp(1 - turn / kTurned, 0.0, 1.0) * unblockedPart(light, r, turn);
  return path;
}

std::optional<double> Translucency::firstLightDistance(const Receiver& r) const {
  for (std::size_t i = 0; i < shadows_.size(); ++i) {
    if (holdsBackFaces(capture_.lights[i])) continue;
    const std::optional<Taps> taps = texelsAround(i, r.position);
    if (!taps) continue;
    std::array<double, 4> weights{};
    double total = 0;
    for (std::size_t k = 0; k < taps->size(); ++k) {
      if ((*taps)[k].found.kind == ShadowView::Kind::Surface) weights[k] = (*taps)[k].weight;
      total += weights[k];
    }
    if (total > 0) return meanThickness(*taps, weights, r);
  }
  return std::nullopt;
}

Transmission Translucency::at(const Surface& surface, const PellucidMaterial& material, int index) const {
  const double mmPerUnit = surfaces_.millimetersPerUnit();
  const Receiver receiver = toWorld(surface, material, index);
  const auto& f = settings_.transmittanceFilter;
  const glm::dvec3 filter(f[0], f[1], f[2]);
  Transmission t;
  if (receiver.chord) t.cameraThickness = *receiver.chord * mmPerUnit;
  if (const auto distance = firstLightDistance(receiver)) t.lightThickness = *distance * mmPerUnit;
  for (std::size_t i = 0; i < capture_.lights.size(); ++i) {
    const LightPath path = material.thinWalled ? thinWallPath(i, receiver)
                           : usesLightSpace(i) ? lightSpacePath(i, receiver)
                                               : cameraSpacePath(i, receiver);
    const glm::dvec3 enters = path.opposite * path.arriving;
    t.arriving += enters;
    if (!(path.reaches > 0)) continue;
    const double thickness = path.thickness * mmPerUnit;
    t.unoccluded += path.reaches * enters;
    if (!(settings_.maximumThickness > 0) || thickness <= double(settings_.maximumThickness))
      t.transmitted += path.reaches * filter * transmittance(material, thickness) * enters;
    if (!t.usedThickness && path.arriving != glm::dvec3(0)) t.usedThickness = thickness;
  }
  return t;
}

}  // namespace pellucid::harness::reference
